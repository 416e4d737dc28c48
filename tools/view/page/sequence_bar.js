// The bar below the picture of a sequence: a slider and the number of the frame, play, loop and the speed limit.
// SPDX-License-Identifier: Apache-2.0
import {numberInput} from "./controls.js";
import {button, element} from "./dom.js";
import {FrameAsker, FrameNumbers} from "./sequence.js";

const kLeastRate = 0.1, kMostRate = 120;  // as the server takes them

/// Fills the bar, which is hidden where the volume is no frame of a sequence.
/// @return actions for keys: { play(), loop(), before(), after() }
export function sequenceBar(bar, session) {
  let numbers = null, dragged = false;
  const send = (message) => session.sequenceCommand(message);
  const asker = new FrameAsker(send, (step) => requestAnimationFrame(step));
  const state = () => session.sequence;
  const present = () => state()?.asked ?? state()?.number ?? 0;

  const playing = button("Play", () => actions.play(), "key P");
  playing.className = "play";
  const slider =
      element("input", { type: "range", min: 0, max: 0, step: 1, value: 0, title: "keys , and .", "aria-label": "frame, slider" });
  const number = numberInput({
    label: "frame",
    whole: true,
    commit: (value) => {
      const shown = numbers.at(numbers.nearest(value));
      number.update(shown);
      asker.ask(shown);
    }
  });
  const range = element("span", { className: "range" });
  const loop = button("Loop", () => actions.loop(), "begin anew at the end; key L");
  const rate = numberInput({
    label: "frames a second, at most",
    low: kLeastRate,
    high: kMostRate,
    commit: (fps) => send({ type: "play", fps })
  });
  rate.node.title = "frames a second, at most";
  bar.append(
      playing, slider, element("span", { className: "wide", textContent: "frame" }), number.node, range, loop,
      element("span", { className: "wide", textContent: "at most" }), rate.node, element("span", { textContent: "/ s" }));

  slider.addEventListener("input", () => {
    dragged = true;
    const shown = numbers.at(Number(slider.value));
    slider.setAttribute("aria-valuetext", `frame ${shown}`);
    number.update(shown);
    asker.drag(shown);
  });
  slider.addEventListener("change", () => {
    dragged = false;
    asker.ask(numbers.at(Number(slider.value)));
  });

  const actions = {
    play: () => numbers && state() && send({ type: "play", on: !state().playing }),
    loop: () => numbers && state() && send({ type: "play", loop: !state().loop }),
    before: () => numbers && state() && asker.ask(numbers.beside(present(), -1, state().loop)),
    after: () => numbers && state() && asker.ask(numbers.beside(present(), 1, state().loop)),
  };
  session.on("hello", ({ sequence }) => {
    numbers = sequence ? new FrameNumbers(sequence) : null;
    bar.hidden = !numbers;
    if (!numbers) return;
    slider.max = numbers.count - 1;
    range.textContent = `of ${numbers.words}`;
    range.title = `${numbers.count} frames`;
  });
  session.on("sequence", (now) => {
    if (!numbers) return;
    playing.textContent = now.playing ? "Stop" : "Play";
    playing.setAttribute("aria-pressed", now.playing);
    loop.setAttribute("aria-pressed", now.loop);
    rate.update(now.fps);
    Object.assign(bar.dataset, { number: now.number, playing: now.playing, reading: now.asked !== null });
    if (dragged) return;
    number.update(present());
    slider.value = numbers.nearest(present());
    slider.setAttribute("aria-valuetext", `frame ${present()}${now.empty ? ", which is empty" : ""}`);
  });
  return actions;
}
