// A small chart of the present picture's error against time, both logarithmic: a straight line down is what averaging
// promises. The error has two parts, that of the samples (dashed), which falls, and that of the steps along rays, which
// stays; samples end at the target (dotted), or where what is left is not theirs.
// SPDX-License-Identifier: Apache-2.0
import {svg} from "./dom.js";
import {chartWords, shortNumber, withErrorPoint} from "./words.js";

const kWidth = 300, kHeight = 132, kLeft = 44, kFoot = 42, kMargin = 8;
const kRight = kWidth - 2 * kMargin, kBottom = kHeight - kFoot;

/// Returns the decades from below `low` to above `high`: [first, last] powers of ten.
export function decades(low, high) {
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high));
  return [first, Math.max(first + 1, last)];
}

function axis([first, last], place, mark) {
  const marks = [];
  for (let i = first; i <= last; ++i) marks.push(...mark(place(10 ** i), shortNumber(10 ** i)));
  return marks;
}

const line = (name, places) => svg(
    "polyline",
    { class: name, points: places.map((place) => place.map((c) => c.toFixed(1)).join(",")).join(" ") });

function marksOf(across, up, x, y) {
  return [
    ...axis(
        across, x,
        (at, text) =>
            [svg("line", { x1: at, x2: at, y1: kMargin, y2: kBottom }),
             svg("text", { x: at, y: kBottom + 14, "text-anchor": "middle" }, `${text} s`)]),
    ...axis(
        up, y,
        (at, text) =>
            [svg("line", { x1: kLeft, x2: kRight, y1: at, y2: at }),
             svg("text", { x: kLeft - 4, y: at + 3, "text-anchor": "end" }, text)])
  ];
}

/// Returns { node, add(status) }.
export function errorChart() {
  const node = svg("svg", { viewBox: `0 0 ${kWidth} ${kHeight}`, class: "chart", role: "img" });
  let history = [], latest = null;
  const draw = () => {
    const words = chartWords(history, latest);
    node.setAttribute("aria-label", words);
    const said = svg("text", { class: "said", x: kLeft, y: kHeight - 6 }, words);
    if (history.length === 0) {
      node.replaceChildren(
          svg("text", { x: kWidth / 2, y: kHeight / 2, "text-anchor": "middle" }, "error against time, once it rests"));
      return;
    }
    const target = latest?.targetError ?? 0;
    const seconds = history.map(({ ms }) => Math.max(1e-3, ms / 1000));
    const parts = history.map(({ standardError }) => standardError).filter((error) => error > 0);
    const errors = [...history.map(({ error }) => error), ...parts, ...(target > 0 ? [target] : [])];
    const across = decades(Math.min(...seconds), Math.max(...seconds));
    const up = decades(Math.min(...errors), Math.max(...errors));
    const x = (s) => kLeft + ((Math.log10(s) - across[0]) / (across[1] - across[0])) * (kRight - kLeft);
    const y = (e) => kBottom - ((Math.log10(e) - up[0]) / (up[1] - up[0])) * (kBottom - kMargin);
    const places = history.map(({ error }, i) => [x(seconds[i]), y(error)]);
    const samples = history.flatMap(({ standardError }, i) => (standardError > 0 ? [[x(seconds[i]), y(standardError)]] : []));
    const [cx, cy] = places.at(-1);
    node.replaceChildren(
        ...marksOf(across, up, x, y),
        ...(target > 0 ? [line("target", [[kLeft, y(target)], [kRight, y(target)]])] : []), line("part", samples),
        line("whole", places), svg("circle", { cx, cy, r: 3, class: latest?.done ? "done" : "" }), said);
  };
  draw();
  return {
    node,
    add: (status) => {
      history = withErrorPoint(history, status);
      latest = status;
      draw();
    },
  };
}
