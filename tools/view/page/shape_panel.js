// Functions of value and gradient magnitude: the plot of shapes, and the chosen one in numbers.
// SPDX-License-Identifier: Apache-2.0
import {colourRow, numberRow} from "./controls.js";
import {button, element} from "./dom.js";
import {ShapeEditor} from "./shape_editor.js";

// Five decades of extinction, about those of a third of what most volumes need.
const kSigmas = {
  toValue: (place) => Number((1e-3 * 10 ** (place / 200)).toPrecision(3)),
  toPlace: (sigma_t) => Math.max(0, 200 * Math.log10(Math.max(sigma_t, 1e-3) / 1e-3)),
};

/// Returns { node, update(), add(kind) }.
export function shapePanel(session) {
  const canvas = element("canvas", {
    className: "transfer shapes",
    tabIndex: 0,
    id: "shapes",
    role: "application",
    "aria-label": "Function of value and gradient magnitude: arrow keys move the chosen shape, Page up and Page down " +
        "choose one, N adds a rectangle, T a triangle, Delete removes it",
  });
  const editor = new ShapeEditor(canvas, session, () => update());
  const which = element("p", { className: "quiet", "aria-live": "polite" });
  const sigma_t = numberRow({
    label: "shape sigma_t",  // that of points has the plain name
    help: "extinction of the chosen shape, 1/world unit; that of shapes that overlap adds up",
    low: 0,
    mapping: kSigmas,
    session,
    toPatch: (value) => editor.changed({ sigma_t: Math.max(0, value) }),
  });
  const colour = colourRow({
    label: "shape albedo",
    help: "share of the extinction that is scattered, linear RGB, at most 1",
    session,
    toPatch: (albedo) => editor.changed({ albedo: albedo.map((c) => Math.min(1, c)) }),
  });
  const remove = button("Remove", () => editor.removeChosen(), "the chosen shape");
  const buttons = element(
      "div", { className: "buttons" }, button("Add rectangle", () => editor.add("rectangle")),
      button("Add triangle", () => editor.add("triangle")), remove);
  const numbers = element("div", {}, sigma_t.node, colour.node);
  const words = () => {
    const { shapes, histogram } = editor;
    if (!histogram) return "Looking at the gradients of the volume ...";
    if (!shapes) return "This function was not made of shapes on this page. To add one begins a new function.";
    if (shapes.length === 0) return "Without a shape nothing is shown.";
    return `Shape ${editor.chosen + 1} of ${shapes.length}, a ${shapes[editor.chosen].kind}`;
  };
  const update = () => {
    which.textContent = words();
    const shape = editor.shapes?.[editor.chosen];
    numbers.hidden = !shape;
    remove.disabled = !shape;
    editor.draw();
    if (!shape) return;
    sigma_t.update(shape.sigma_t);
    colour.update(shape.albedo);
  };
  return { node: element("div", {}, canvas, which, buttons, numbers), update, add: (kind) => editor.add(kind) };
}
