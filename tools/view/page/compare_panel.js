// Compares what is drawn with the reference, at small size: a button, how far it is, and then the numbers of
// `umbrick compare` with the two pictures and their difference.
// SPDX-License-Identifier: Apache-2.0
import {button, element, section} from "./dom.js";
import {shortNumber} from "./words.js";

const pngOf = (text) => `data:image/png;base64,${text}`;

/// Returns the three pictures of a comparison with their words: [{ title, help, source }].
export function comparedPictures({ pictures, top }) {
  return [
    { title: "drawn", help: "as umbrick render makes it at this size", source: pngOf(pictures.drawn) },
    { title: "reference", help: "as umbrick reference makes it", source: pngOf(pictures.reference) },
    {
      title: "difference",
      help: "largest of the channels: black is 0, light yellow " + shortNumber(top),
      source: pngOf(pictures.difference)
    },
  ];
}

function figureOf({ title, help, source }, onclick) {
  const image = element("img", { src: source, alt: `${title}: ${help}` });
  return element(
      "figure", { title: help }, element("button", { type: "button", className: "bare", onclick }, image),
      element("figcaption", { textContent: title }));
}

// The pictures side by side, as large as the window allows.
function enlarge(pictures, text) {
  const figures = pictures.map(({ title, help, source }) => element(
      "figure", {}, element("img", { src: source, alt: title }), element("figcaption", { textContent: `${title}: ${help}` })));
  const dialog = element(
      "dialog", { className: "compared", "aria-label": "Comparison with the reference" },
      element("form", { method: "dialog" }, element("strong", { textContent: text }), element("button", { textContent: "Close" })),
      element("div", { className: "figures" }, ...figures));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

function resultNodes(result) {
  const pictures = comparedPictures(result);
  const large = () => enlarge(pictures, result.text);
  const numbers = element("dl", { className: "measures" });
  for (const { title, help, value } of result.measures)
    numbers.append(
        element("dt", { textContent: title, title: help }),
        element("dd", { textContent: value === null ? "infinite" : shortNumber(value, 3), title: help }));
  const scale = element(
      "div", { className: "magma", role: "img", "aria-label": `difference from 0 to ${shortNumber(result.top)}` },
      element("span", { textContent: "0" }), element("span", { textContent: shortNumber(result.top) }));
  const about = `${result.size.join(" x ")} pixels, ${shortNumber(result.seconds, 2)} s`;
  return [
    element("p", { className: "verdict", textContent: result.text }),
    element("div", { className: "figures" }, ...pictures.map((picture) => figureOf(picture, large))), scale, numbers,
    element("p", { className: "quiet", textContent: about })
  ];
}

/// Returns the section.
export function comparePanel(session) {
  const start = button(
      "Compare with reference", () => session.command({ type: "compare" }),
      "computes the same scene without approximations, at small size, while the picture goes on");
  const stop = button("Stop", () => session.command({ type: "stopCompare" }));
  const bar = element("progress", { max: 1, value: 0, "aria-label": "how far the reference is" });
  const share = element("output", {});
  const running = element("div", { className: "controls" }, bar, share, stop);
  const words = element("p", { className: "quiet", role: "status" });
  const result = element("div", {});
  const kIdle = "How far this picture is from the exact one, at small size.";
  const show = (message) => {
    start.hidden = message.state === "running";
    running.hidden = !start.hidden;
    bar.value = message.share ?? 0;
    share.textContent = `${Math.round(100 * (message.share ?? 0))} %`;
    words.hidden = message.state !== "none";
    words.textContent = message.text || kIdle;
    result.replaceChildren(...(message.state === "done" ? resultNodes(message) : []));
    node.dataset.state = message.state;
  };
  const node = section(
      "Against the reference", false, element("div", { className: "buttons" }, start), running, words, result);
  session.on("comparison", show);
  show({ state: "none" });
  return node;
}
