// What lies over the picture: the world's axes (a triad) and a bar of a round length at the camera's target.
// SPDX-License-Identifier: Apache-2.0
import {heightAtTarget, toView} from "./camera.js";
import {svg} from "./dom.js";
import {roundLength} from "./plot_axes.js";
import {shortNumber} from "./words.js";

const kArm = 30, kLetter = 38;
const kWorld = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];
const kLongestBar = 0.25;  // heights of the picture

/// Draws the triad. Arms that point away from the viewer are drawn first, and fainter.
export function drawTriad(node, axes) {
  const arms = kWorld.map(([name, direction]) => ({ name, view: toView(axes, direction) }))
                   .sort((a, b) => a.view[2] - b.view[2]);
  node.replaceChildren(...arms.map(
      ({ name, view: [x, y, z] }) =>
          svg("g", { class: `axis-${name}`, opacity: z < -0.2 ? 0.55 : 1 },
              svg("line", { x1: 0, y1: 0, x2: kArm * x, y2: -kArm * y }),
              svg("text", { x: kLetter * x, y: -kLetter * y + 4, "text-anchor": "middle" }, name))));
}

/// Sets the bar's length in pixels and its words.
export function drawScaleBar(node, {camera, resolved}, shownHeight) {
  const height = heightAtTarget(camera, resolved);
  const length = roundLength(height * kLongestBar);
  node.style.width = `${(length / height) * shownHeight}px`;
  node.textContent = shortNumber(length);
  node.title = "world units, at the depth of the camera's target";
}
