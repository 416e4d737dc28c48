// A small chart of the present picture's error against time, both logarithmic: a straight line down is what averaging
// promises.
// SPDX-License-Identifier: Apache-2.0
import {svg} from "./dom.js";
import {shortNumber, withErrorPoint} from "./words.js";

const kWidth = 300, kHeight = 110, kLeft = 44, kFoot = 24, kMargin = 8;

function decades(low, high) {
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high));
  return [first, Math.max(first + 1, last)];
}

function axis([first, last], place, label) {
  const marks = [];
  for (let i = first; i <= last; ++i) marks.push(...label(place(10 ** i), shortNumber(10 ** i)));
  return marks;
}

/// Returns { node, add(status) }.
export function errorChart() {
  const node = svg("svg", { viewBox: `0 0 ${kWidth} ${kHeight}`, class: "chart", role: "img" });
  let history = [];
  const draw = () => {
    const last = history.at(-1);
    node.setAttribute(
        "aria-label",
        last ? `Error ${shortNumber(last.error, 2)} after ${shortNumber(last.ms / 1000, 2)} s` :
               "No error is known yet");
    if (!last) {
      node.replaceChildren(
          svg("text", { x: kWidth / 2, y: kHeight / 2, "text-anchor": "middle" }, "error against time, once it rests"));
      return;
    }
    const seconds = history.map((point) => Math.max(1e-3, point.ms / 1000)),
          errors = history.map((point) => point.error);
    const across = decades(Math.min(...seconds), Math.max(...seconds)),
          up = decades(Math.min(...errors), Math.max(...errors));
    const x = (s) => kLeft + ((Math.log10(s) - across[0]) / (across[1] - across[0])) * (kWidth - kLeft - 2 * kMargin);
    const y = (e) => kHeight - kFoot - ((Math.log10(e) - up[0]) / (up[1] - up[0])) * (kHeight - kFoot - kMargin);
    const right = kWidth - 2 * kMargin, foot = kHeight - kFoot;
    const across_ = axis(
        across, x,
        (at, text) =>
            [svg("line", { x1: at, x2: at, y1: kMargin, y2: foot }),
             svg("text", { x: at, y: kHeight - 8, "text-anchor": "middle" }, `${text} s`)]);
    const up_ = axis(
        up, y,
        (at, text) =>
            [svg("line", { x1: kLeft, x2: right, y1: at, y2: at }),
             svg("text", { x: kLeft - 4, y: at + 3, "text-anchor": "end" }, text)]);
    const places = history.map((point, i) => [x(seconds[i]), y(point.error)].map((c) => c.toFixed(1)));
    node.replaceChildren(
        ...across_, ...up_, svg("polyline", { points: places.map((p) => p.join(",")).join(" ") }),
        svg("circle", { cx: places.at(-1)[0], cy: places.at(-1)[1], r: 3 }));
  };
  draw();
  return {
    node,
    add: (status) => {
      history = withErrorPoint(history, status);
      draw();
    },
  };
}
