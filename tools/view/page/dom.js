// Makes elements of the page. All text is set as text, never as HTML, since names of files come from outside.
// SPDX-License-Identifier: Apache-2.0
const kSvg = "http://www.w3.org/2000/svg";

/// element("button", { textContent: "Undo", onclick: f, "aria-label": "..." }, ...children). Names with a dash and
/// those in `attributes` become attributes, the others properties.
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role" || name === "for")
      made.setAttribute(name, value);
    else if (name === "dataset")
      Object.assign(made.dataset, value);
    else
      made[name] = value;
  }
  made.append(...children);
  return made;
}

export function svg(tag, attributes = {}, ...children) {
  const made = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

export const button = (text, onclick, title = "") =>
    element("button", {type: "button", textContent: text, onclick, title});

/// A section that folds.
export function section(title, open, ...children) {
  return element("details", { className: "section", open }, element("summary", { textContent: title }), ...children);
}

let ids = 0;
export const newId = () => `id${++ids}`;
