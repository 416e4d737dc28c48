// What is known of the volume and of the program.
// SPDX-License-Identifier: Apache-2.0
import {element, section} from "./dom.js";
import {shortNumber} from "./words.js";

export function infoPanel(session) {
  const { volume, version, engine } = session.hello;
  const vector = (v) => v.map((x) => shortNumber(x, 6)).join(", ");
  const facts = [
    ["file", volume.file],
    ["grid", volume.grid],
    ["voxels", volume.dims.join(" x ")],
    ["values", `${shortNumber(volume.low)} to ${shortNumber(volume.high)}${volume.unit ? " " + volume.unit : ""}`],
    ["bounds", `(${vector(volume.bounds[0])}) to (${vector(volume.bounds[1])})`],
    ["drawn by", engine || "..."],
    ["Umbrick", version],
  ];
  const rows =
      facts.filter(([, fact]) => fact)
          .flatMap(([name, fact]) => [element("dt", { textContent: name }), element("dd", { textContent: fact })]);
  const list = element("dl", {}, ...rows);
  // What draws may be known, or change, after the page was opened.
  session.on("engine", ({ text }) => {
    const name = [...list.querySelectorAll("dt")].find((each) => each.textContent === "drawn by");
    name.nextElementSibling.textContent = text;
  });
  return section("Volume", false, list);
}
