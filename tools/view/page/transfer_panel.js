// The section of the transfer function: the plot, the chosen point in numbers, presets, files, window and scale.
// SPDX-License-Identifier: Apache-2.0
import {choiceRow, colourRow, flagRow, numberInput, row} from "./controls.js";
import {button, element, newId, section} from "./dom.js";
import {replacingPatch} from "./merge_patch.js";
import {shapePanel} from "./shape_panel.js";
import {loadedPatch, scaled, windowed, withPoint} from "./transfer.js";
import {TransferEditor} from "./transfer_editor.js";

const kPick = "choose ...";
const kKinds = ["value", "value and gradient"];

// The chosen point in numbers. @return { node, update(points) }
function pointControls(session, editor) {
  const changed = (fields) => editor.patch(withPoint(editor.points, editor.chosen, fields));
  const field = (label, help, name) => {
    const input = numberInput({ label, commit: (value) => session.edit(changed({ [name]: value })) });
    input.node.id = newId();
    return { node: row(label, help, input.node.id, input.node), update: input.update };
  };
  const value = field("value", "of the chosen point, in units of the volume", "value");
  const sigma_t = field("sigma_t", "extinction of the chosen point, 1/world unit", "sigma_t");
  const colour = colourRow({
    label: "albedo",
    help: "share of the extinction that is scattered, linear RGB, at most 1",
    session,
    toPatch: (albedo) => changed({ albedo: albedo.map((c) => Math.min(1, c)) }),
  });
  const which = element("p", { className: "quiet", "aria-live": "polite" });
  const remove = button("Remove point", () => editor.removeChosen());
  const buttons = element("div", { className: "buttons" }, button("Add point", () => editor.addBeside()), remove);
  return {
    node: element("div", {}, which, value.node, sigma_t.node, colour.node, buttons),
    update: (points) => {
      const chosen = points[editor.chosen];
      which.textContent = `Point ${editor.chosen + 1} of ${points.length}`;
      value.update(chosen.value);
      sigma_t.update(chosen.sigma_t);
      colour.update(chosen.albedo);
      remove.disabled = points.length < 2;
    },
  };
}

// What changes all points together. @return { node, update(points) }
function wholeControls(session, editor, problem) {
  const moveEnd = (i, value) => {
    const points = editor.points, ends = [points[0].value, points.at(-1).value];
    ends[i] = value;
    if (ends[0] < ends[1]) return session.edit(editor.patch(windowed(points, ...ends)));
    problem("The window's low end must be below its high end.");
  };
  const low = numberInput({ label: "window, low", commit: (value) => moveEnd(0, value) });
  const high = numberInput({ label: "window, high", commit: (value) => moveEnd(1, value) });
  low.node.id = newId();
  const scaleBy = (factor) => session.edit(editor.patch(scaled(editor.points, factor)));
  const scales = element(
      "div", { className: "buttons" }, button("sigma_t / 1.5", () => scaleBy(1 / 1.5), "thinner everywhere"),
      button("sigma_t x 1.5", () => scaleBy(1.5), "denser everywhere"));
  const logarithmic = flagRow({
    label: "logarithmic sigma_t",
    help: "four decades of the extinction",
    commit: (on) => editor.setLogarithmic(on),
  });
  const windowRow = row("window", "stretches the function to these values", low.node.id, low.node, high.node);
  return {
    node: element("div", {}, windowRow, scales, logarithmic.node),
    update: (points) => {
      low.update(points[0].value);
      high.update(points.at(-1).value);
    },
  };
}

// Where a whole function comes from: presets, the volume itself, files.
function sourceControls(session, editor, problem) {
  const presets = choiceRow({
    label: "preset",
    choices: [kPick, ...session.hello.presets],
    commit: (name) => {
      if (name !== kPick) session.edit({ transfer: name });
      presets.update(kPick);
    },
  });
  const file = element("input", { type: "file", accept: ".json,application/json", hidden: true });
  file.addEventListener("change", async () => {
    const [chosen] = file.files;
    if (!chosen) return;
    try {
      session.edit(loadedPatch(session.scene.transfer, await chosen.text()));
    } catch (error) {
      problem(`${chosen.name}: ${error.message}`);
    }
    file.value = "";
  });
  const showAll = button("Show all", () => editor.showAll(), "undoes the zoom on the values");
  const buttons = element(
      "div", { className: "buttons" },
      button("Auto", () => session.edit({ transfer: "auto" }), "a function that fits the volume"),
      button("Load ...", () => file.click(), "a transfer function, or a colour map exported by ParaView (JSON)"), showAll);
  return { node: element("div", {}, presets.node, buttons, file), showAll };
}

export function transferPanel(session, problem) {
  const canvas = element("canvas", {
    className: "transfer",
    tabIndex: 0,
    id: "transfer",
    role: "application",
    "aria-label": "Transfer function: arrow keys move the chosen point, Page up and Page down choose one, " +
        "N adds one, Delete removes it",
  });
  const editor = new TransferEditor(canvas, session, () => update());
  const point = pointControls(session, editor), whole = wholeControls(session, editor, problem);
  const sources = sourceControls(session, editor, problem), shapes = shapePanel(session);
  // The function of the value alone that was there last, so that the way back does not lose it.
  let last = null;
  const back = () => (last ? { transfer: replacingPatch(session.scene.transfer, last) } : { transfer: "auto" });
  const kind = choiceRow({
    label: "function of",
    help: "the value alone, or value and gradient magnitude, by which surfaces are told from what lies between them",
    choices: kKinds,
    commit: (name) => {
      if (name === kKinds[0]) return session.edit(back());
      shapes.add("rectangle");
      update();  // the function changes when its gradients are known
    },
  });
  const update = () => {
    const { points } = editor, lattice = Boolean(session.scene?.transfer?.gradients);
    kind.update(kKinds[lattice ? 1 : 0]);
    shapes.node.hidden = !lattice;
    canvas.hidden = sources.showAll.hidden = lattice;
    point.node.hidden = whole.node.hidden = !points;
    if (lattice) shapes.update();
    if (!points) return;
    last = session.scene.transfer;
    point.update(points);
    whole.update(points);
  };
  return section(
      "Transfer function", true, kind.node, canvas, shapes.node, sources.node, point.node, whole.node);
}
