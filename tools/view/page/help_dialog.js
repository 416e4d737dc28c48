// The list of keys.
// SPDX-License-Identifier: Apache-2.0
import {element} from "./dom.js";
import {kKeyList} from "./keys.js";

function keyRows(rows) {
  const list = element("dl");
  for (const [keys, meaning] of rows)
    list.append(element("dt", { textContent: keys }), element("dd", { textContent: meaning }));
  return list;
}

export function helpDialog() {
  const sections = element("div");
  for (const [title, rows] of kKeyList)
    sections.append(element("section", {}, element("h3", { textContent: title }), keyRows(rows)));
  // The button stands above the list: it gets the focus, and what has the focus is scrolled to.
  return element(
      "dialog", { className: "help", "aria-label": "Keys and gestures" },
      element("form", { method: "dialog" }, element("button", { textContent: "Close" })), sections);
}
