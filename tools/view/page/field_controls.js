// Controls of scene fields as the server's table lists them, so that a new field appears without a change here.
// SPDX-License-Identifier: Apache-2.0
import {choiceRow, colourRow, flagRow, numberRow, row, textRow, vectorInput} from "./controls.js";
import {element, newId} from "./dom.js";
import {isShown, labelOf, sliderOf} from "./fields.js";
import {patchOf, valueAt} from "./merge_patch.js";

const kAxes = ["x", "y", "z", "w"];

function vectorRow(field, label, session, count) {
  const size = field.kind === "size";
  const names = size ? ["width", "height"] : kAxes.slice(0, count);
  const commit = (value) => session.edit(patchOf(field.path, value));
  const input = vectorInput({ label, names, whole: size, commit });
  const id = newId();
  input.node.querySelector("input").id = id;
  return { node: row(label, field.help, id, input.node), update: input.update };
}

function controlOf(field, session) {
  const label = labelOf(field), { help, low, high, unit } = field;
  const toPatch = (value) => patchOf(field.path, value);
  const commit = (value) => session.edit(toPatch(value));
  if (field.choices?.length) return choiceRow({ label, help, choices: field.choices, commit });
  const present = valueAt(session.scene, field.path);
  switch (field.kind) {
    case "number":
    case "integer":
      return numberRow({
        label,
        help,
        unit,
        whole: field.kind === "integer",
        low,
        high,
        mapping: sliderOf(field),
        session,
        toPatch
      });
    case "colour":
      return colourRow({ label, help, session, toPatch });
    case "flag":
      return flagRow({ label, help, commit });
    case "vector":
    case "size":
      return vectorRow(field, label, session, present.length);
    default:
      return textRow({ label, help, commit });
  }
}

/// Returns { node, update() } of some fields. Controls are made when a scene first has the field.
export function fieldControls(fields, session) {
  const node = element("div", { className: "fields" });
  const controls = new Map();
  const update = () => {
    for (const field of fields) {
      const shown = isShown(field, session.scene);
      if (shown && !controls.has(field)) {
        const control = controlOf(field, session);
        control.node.dataset.path = field.path;
        controls.set(field, control);
        node.replaceChildren(...fields.filter((f) => controls.has(f)).map((f) => controls.get(f).node));
      }
      const control = controls.get(field);
      if (!control) continue;
      control.node.hidden = !shown;
      if (shown) control.update(valueAt(session.scene, field.path));
    }
  };
  return { node, update };
}
