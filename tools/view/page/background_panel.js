// Ambient light, and what is behind the volume.
// SPDX-License-Identifier: Apache-2.0
import {colourRow, flagRow} from "./controls.js";
import {section} from "./dom.js";

const kFirstBackground = [0.03, 0.035, 0.045];  // dark, so that what scatters little is still seen

/// Returns { node, update() }.
export function backgroundPanel(session) {
  const ambient = colourRow({
    label: "ambient",
    help: "radiance from every direction, linear RGB",
    session,
    toPatch: (value) => ({ light: { ambient: value } })
  });
  let last = kFirstBackground;
  const opaque = flagRow({
    label: "background",
    help: "radiance behind the volume; makes the picture opaque",
    commit: (on) => session.edit({ light: { background: on ? last : null } }),
  });
  const background = colourRow(
      { label: "its colour", help: "linear RGB", session, toPatch: (value) => ({ light: { background: value } }) });
  return {
    node: section("Background and ambient", false, ambient.node, opaque.node, background.node),
    update: () => {
      const { ambient: light, background: behind } = session.scene.light;
      ambient.update(light);
      opaque.update(Boolean(behind));
      background.node.hidden = !behind;
      last = behind ?? last;
      background.update(last);
    },
  };
}
