// The list of keys.
// SPDX-License-Identifier: Apache-2.0
import {element} from "./dom.js";
import {kKeyList} from "./keys.js";

export function helpDialog() {
  const parts = kKeyList.map(
      ([title, rows]) => element(
          "section", {}, element("h3", { textContent: title }),
          element(
              "dl", {},
              ...rows.flatMap(
                  ([keys,
                    meaning]) => [element("dt", { textContent: keys }), element("dd", { textContent: meaning })]))));
  return element(
      "dialog", { className: "help", "aria-label": "Keys and gestures" },
      element("h2", { textContent: "Keys and gestures" }), ...parts,
      element("form", { method: "dialog" }, element("button", { textContent: "Close" })));
}
