// Controls of single values: numbers with and without a slider, vectors, choices, flags, texts, colours. Each returns
// { node, update(value) }. While a slider or picker moves, edits are those of one drag.
// SPDX-License-Identifier: Apache-2.0
import {hexOfLinear, linearOfHex, splitRadiance} from "./colour.js";
import {element, newId} from "./dom.js";
import {readNumber} from "./fields.js";
import {shortNumber} from "./words.js";

/// Lays out a label and its control. The help is shown by the pointer and read by screen readers.
export function row(label, help, id, ...controls) {
  const title = element("label", { textContent: label, for: id, htmlFor: id, title: help });
  return element(
      "div", { className: "row", title: help }, title, element("div", { className: "controls" }, ...controls));
}

const isTyping = (input) => document.activeElement === input && input.dataset.typed === "yes";

/// An input for one number.
/// @param commit  called with the number when it was entered; what is no number is put back
export function numberInput({label, whole = false, low, high, commit}) {
  const input = element("input", { type: "text", inputMode: "decimal", className: "number", "aria-label": label });
  let shown = "";
  const show = (value) => {
    shown = whole ? String(value) : shortNumber(value);
    if (!isTyping(input)) input.value = shown;
  };
  const enter = () => {
    delete input.dataset.typed;
    if (input.value === shown) return;
    const value = readNumber(input.value, whole);
    input.classList.toggle("wrong", value === undefined);
    if (value === undefined)
      input.value = shown;
    else
      commit(value);
  };
  const step = (sign, event) => {
    const value = readNumber(input.value, whole);
    if (value === undefined) return;
    const size = whole ? 1 : 10 ** Math.floor(Math.log10(Math.abs(value) || 1) - 1);
    const next = value + sign * size * (event.shiftKey ? 10 : 1);
    commit(Math.min(high ?? Infinity, Math.max(low ?? -Infinity, Number(next.toPrecision(9)))));
    event.preventDefault();
  };
  input.addEventListener("input", () => (input.dataset.typed = "yes"));
  input.addEventListener("change", enter);
  input.addEventListener("keydown", (event) => {
    if (event.key === "ArrowUp") step(1, event);
    if (event.key === "ArrowDown") step(-1, event);
    if (event.key === "Escape") {
      delete input.dataset.typed;
      input.value = shown;
    }
  });
  return { node: input, update: show };
}

/// A slider from 0 to 1000.
/// @param mapping  { toValue, toPlace }
/// @param drag     begins a drag and returns { edit(value), end() }
export function sliderInput({label, mapping, drag}) {
  const input = element("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": label });
  let current = null;
  input.addEventListener("input", () => {
    current ??= drag();
    current.edit(mapping.toValue(Number(input.value)));
  });
  const end = () => {
    current?.end();
    current = null;
  };
  input.addEventListener("change", end);
  input.addEventListener("pointercancel", end);
  return {
    node: input,
    update: (value) => {
      if (!current) input.value = mapping.toPlace(value);
      input.setAttribute("aria-valuetext", shortNumber(value));
    },
  };
}

/// A number with its slider where it has one, as a row.
/// @param session,toPatch  an edit is toPatch(value)
export function numberRow({label, help = "", unit = "", whole, low, high, mapping, session, toPatch}) {
  const number = numberInput({ label, whole, low, high, commit: (value) => session.edit(toPatch(value)) });
  const id = newId();
  number.node.id = id;
  const parts = [number];
  if (mapping)
    parts.unshift(sliderInput({ label: `${label}, slider`, mapping, drag: () => dragOf(session, label, toPatch) }));
  const text = unit ? `${label} (${unit})` : label;
  return {
    node: row(text, help, id, ...parts.map((part) => part.node)),
    update: (value) => parts.forEach((p) => p.update(value))
  };
}

/// A drag whose edits are toPatch(value).
export function dragOf(session, name, toPatch) {
  const drag = session.drag(name);
  return { edit: (value) => drag.edit(toPatch(value)), end: drag.end };
}

/// Several numbers side by side. @param commit  called with all of them
export function vectorInput({label, names, whole = false, commit}) {
  let values = names.map(() => 0);
  const parts = names.map((name, i) => numberInput({
                            label: `${label}, ${name}`,
                            whole,
                            commit: (value) => commit(values.map((old, k) => (k === i ? value : old)))
                          }));
  const node = element("div", { className: "vector" }, ...parts.map((part) => part.node));
  return {
    node,
    update: (next) => {
      values = next;
      parts.forEach((part, i) => part.update(next[i]));
    },
  };
}

export function choiceRow({label, help = "", choices, commit}) {
  const id = newId();
  const options = choices.map((choice) => element("option", { value: String(choice), textContent: String(choice) }));
  const select = element("select", { id }, ...options);
  select.addEventListener("change", () => commit(choices[select.selectedIndex]));
  return { node: row(label, help, id, select), update: (value) => (select.value = String(value)) };
}

export function flagRow({label, help = "", commit}) {
  const id = newId();
  const box = element("input", { type: "checkbox", id });
  box.addEventListener("change", () => commit(box.checked));
  return { node: row(label, help, id, box), update: (value) => (box.checked = value), box };
}

export function textRow({label, help = "", commit}) {
  const id = newId();
  const input = element("input", { type: "text", id });
  input.addEventListener("input", () => (input.dataset.typed = "yes"));
  input.addEventListener("change", () => {
    delete input.dataset.typed;
    commit(input.value);
  });
  return {
    node: row(label, help, id, input),
    update: (value) => {
      if (!isTyping(input)) input.value = value;
    },
  };
}

/// A picker and three numbers of linear light. Radiance above 1 keeps its strength while the picker changes its colour.
/// @param toPatch  of a linear colour
function colourInput({ label, session, toPatch }) {
  let value = [0, 0, 0], current = null;
  const picker = element("input", { type: "color", "aria-label": `${label}, picker` });
  const picked = () => linearOfHex(picker.value).map((c) => Number((c * splitRadiance(value).strength).toPrecision(6)));
  picker.addEventListener("input", () => {
    current ??= dragOf(session, label, toPatch);
    current.edit(picked());
  });
  picker.addEventListener("change", () => {
    current?.end();
    current = null;
  });
  const numbers = vectorInput({
    label: `${label}, linear`,
    names: ["red", "green", "blue"],
    commit: (rgb) => session.edit(toPatch(rgb)),
  });
  return {
    node: element("div", { className: "colour" }, picker, numbers.node),
    update: (rgb) => {
      value = rgb;
      numbers.update(rgb);
      if (!current) picker.value = hexOfLinear(splitRadiance(rgb).colour);
    },
  };
}

export function colourRow(options) {
  const id = newId();
  const input = colourInput(options);
  input.node.querySelector("input").id = id;
  return { node: row(options.label, options.help ?? "", id, input.node), update: input.update };
}
