// The section of the transfer function: the plot, the chosen point in numbers, presets, files, window and scale.
// SPDX-License-Identifier: Apache-2.0
import {choiceRow, colourInput, flagRow, numberInput, row} from "./controls.js";
import {button, element, newId, section} from "./dom.js";
import {loadedPatch, scaled, windowed, withPoint} from "./transfer.js";
import {TransferEditor} from "./transfer_editor.js";

const kPick = "choose ...";

export function transferPanel(session, problem) {
  const canvas = element("canvas", { className: "transfer", tabIndex: 0, id: "transfer", role: "application" });
  canvas.setAttribute(
      "aria-label",
      "Transfer function: arrow keys move the chosen point, Page up and Page down choose one, N adds, Delete removes");
  const editor = new TransferEditor(canvas, session, () => update());

  const changeChosen = (fields) => editor.patch(withPoint(editor.points, editor.chosen, fields));
  const field = (label, help, name) => {
    const input = numberInput({ label, commit: (value) => session.edit(changeChosen({ [name]: value })) });
    const id = newId();
    input.node.id = id;
    return { node: row(label, help, id, input.node), update: input.update };
  };
  const value = field("value", "of the chosen point, in units of the volume", "value");
  const sigma_t = field("sigma_t", "extinction of the chosen point, 1/world unit", "sigma_t");
  const colour = colourInput(
      { label: "albedo", session, toPatch: (albedo) => changeChosen({ albedo: albedo.map((c) => Math.min(1, c)) }) });
  const colourId = newId();
  colour.node.querySelector("input").id = colourId;
  const which = element("p", { className: "quiet" });
  which.setAttribute("aria-live", "polite");
  const remove = button("Remove point", () => editor.removeChosen());
  const pointButtons = element("div", { className: "buttons" }, button("Add point", () => editor.addBeside()), remove);
  const point = element(
      "div", {}, which, value.node, sigma_t.node,
      row("albedo", "share of the extinction that is scattered, linear RGB", colourId, colour.node), pointButtons);

  const ends = ["low", "high"].map((name, i) => numberInput({
                                     label: `window, ${name}`,
                                     commit: (end) => {
                                       const points = editor.points, window = [points[0].value, points.at(-1).value];
                                       window[i] = end;
                                       if (window[0] < window[1])
                                         session.edit(editor.patch(windowed(points, ...window)));
                                       else
                                         problem("The window's low end must be below its high end.");
                                     },
                                   }));
  const windowId = newId();
  ends[0].node.id = windowId;
  const windowRow = row("window", "stretches the function to these values", windowId, ...ends.map((end) => end.node));
  const scaleBy = (factor) => () => session.edit(editor.patch(scaled(editor.points, factor)));
  const scales = element(
      "div", { className: "buttons" }, button("sigma_t / 1.5", scaleBy(1 / 1.5), "thinner everywhere"),
      button("sigma_t x 1.5", scaleBy(1.5), "denser everywhere"));

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
  const logarithmic = flagRow({
    label: "logarithmic sigma_t",
    help: "four decades of the extinction",
    commit: (on) => editor.setLogarithmic(on)
  });
  const buttons = element(
      "div", { className: "buttons" },
      button("Auto", () => session.edit({ transfer: "auto" }), "a function that fits the volume"),
      button("Load ...", () => file.click(), "a transfer function, or a colour map exported by ParaView (JSON)"),
      button("Show all", () => editor.showAll(), "undoes the zoom on the values"));
  const oneDimension = element("div", {}, point, windowRow, scales, logarithmic.node);
  const lattice = element("p", {
    className: "quiet",
    textContent: "This is a function of value (to the right) and gradient magnitude (up). It is shown, not edited. " +
        "A preset or Auto takes its place."
  });

  function update() {
    const points = editor.points;
    lattice.hidden = !session.scene?.transfer?.gradients;
    oneDimension.hidden = !points;
    if (!points) return;
    const chosen = points[editor.chosen];
    which.textContent = `Point ${editor.chosen + 1} of ${points.length}`;
    value.update(chosen.value);
    sigma_t.update(chosen.sigma_t);
    colour.update(chosen.albedo);
    ends[0].update(points[0].value);
    ends[1].update(points.at(-1).value);
    remove.disabled = points.length < 2;
  }
  return section("Transfer function", true, canvas, lattice, presets.node, buttons, file, oneDimension);
}
