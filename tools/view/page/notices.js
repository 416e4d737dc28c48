// One line for each error and note, which can be dismissed. The same line is not shown twice.
// SPDX-License-Identifier: Apache-2.0
import {button, element} from "./dom.js";

const kMost = 4;
const kNoteMs = 8000;  // notes go by themselves, errors stay

export class Notices {
  constructor(node) { this.node_ = node; }
  error(text) { this.show_(text, "error"); }
  note(text) {
    const line = this.show_(text, "note");
    setTimeout(() => line.remove(), kNoteMs);
  }
  show_(text, kind) {
    for (const line of this.node_.children)
      if (line.dataset.text === text) line.remove();
    const line = element("div", { className: `notice ${kind}`, dataset: { text } });
    line.append(element("span", { textContent: text }), button("\u00d7", () => line.remove()));
    line.lastChild.setAttribute("aria-label", "Dismiss");
    this.node_.append(line);
    while (this.node_.children.length > kMost) this.node_.firstChild.remove();
    return line;
  }
}
