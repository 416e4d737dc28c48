// The panel at the side: sections of its own for what needs more than a number, and one for each group of fields.
// SPDX-License-Identifier: Apache-2.0
import {backgroundPanel} from "./background_panel.js";
import {kAxisViews, orbitTo, toWorld} from "./camera.js";
import {clipPanel} from "./clip_panel.js";
import {comparePanel} from "./compare_panel.js";
import {flagRow} from "./controls.js";
import {button, element, section} from "./dom.js";
import {errorChart} from "./error_chart.js";
import {fieldControls} from "./field_controls.js";
import {grouped} from "./fields.js";
import {infoPanel} from "./info_panel.js";
import {lightPanel} from "./light_panel.js";
import {completed, kNewLight} from "./lights.js";
import {savePanel} from "./save_panel.js";
import {surfacePanel} from "./surface_panel.js";
import {transferPanel} from "./transfer_panel.js";

// Edits of fields, with what the chosen model cannot be without.
function completing(session) {
  const axis = () => toWorld(session.view().axes, kNewLight);
  return {
    get scene() { return session.scene; },
    edit: (patch) => session.edit(completed(patch, session.scene, axis())),
    drag: (name) => session.drag(name),
  };
}

function cameraExtras(session, picture) {
  const follow = flagRow({
    label: "size of the window",
    help: "the picture is as large as its place in the window",
    commit: (on) => picture.setFollowsWindow(on),
  });
  follow.update(picture.followsWindow);
  picture.onFollow = follow.update;
  const views = kAxisViews.map(
      ({ key, name, azimuth, elevation }) => button(
          name, () => session.edit(orbitTo(session.scene.camera, { azimuth, elevation, pan: [0, 0] })), `key ${key}`));
  return element("div", {}, element("div", { className: "buttons" }, ...views), follow.node);
}

/// Fills the panel. @return { update() }
export function buildPanels(panel, session, picture, notices) {
  const { hello } = session;
  const problem = (text) => notices.error(text), note = (text) => notices.note(text);
  const parts = [];
  const keep = (part) => {
    parts.push(part);
    return part.node;
  };
  const chart = errorChart();
  session.on("status", (status) => chart.add(status));
  const groups = new Map(
      grouped(hello.fields).map(({ name, fields }) => [name, keep(fieldControls(fields, completing(session)))]));
  const sections = [transferPanel(session, problem)];
  for (const [name, node] of groups) {
    const extras = name === "Light" ? [keep(lightPanel(session))] : [];
    const first = name === "Camera" ? [cameraExtras(session, picture)] : [];
    sections.push(section(name, name === "Light", ...first, node, ...extras));
  }
  // Light is what is changed most after the function, so that it stands second.
  const light = [...groups.keys()].indexOf("Light") + 1;
  if (light > 1) sections.splice(1, 0, ...sections.splice(light, 1));
  sections.splice(
      2, 0, keep(clipPanel(session)), keep(backgroundPanel(session)), section("Error against time", true, chart.node),
      comparePanel(session));
  const surfaces = surfacePanel(session);
  sections.splice(1, 0, keep(surfaces));
  sections.push(keep(savePanel(session, note)), infoPanel(session));
  panel.replaceChildren(...sections);
  parts.forEach((part) => part.update());
  // A section that is folded is brought up to date when it is opened.
  const updateOpen = () => {
    parts.filter((part) => part.node.closest("details").open).forEach((part) => part.update());
    surfaces.update();  // is shown or hidden by the mode
  };
  for (const each of sections) each.addEventListener("toggle", updateOpen);
  return { update: updateOpen };
}
