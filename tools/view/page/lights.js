// Light sources of a scene, as merge patches, and the ball by which a direction is chosen.
// SPDX-License-Identifier: Apache-2.0
import {normalize} from "./vector.js";

/// Where a new light is, in the view: to the upper right of the viewer.
export const kNewLight = [0.4, 0.6, 0.7];

/// A new source: a lamp of five degrees, in the world's frame.
export function newSource(axis) {
  return { type: "cone", frame: "world", axis: axis.map((x) => Number(x.toFixed(4))), theta: 5, radiance: [1, 1, 1] };
}

export const sourcesOf = (scene) => scene.light?.sources ?? [];

/// Adds a source and chooses the model that looks at it.
export function addSource(scene, source) {
  return completed({ model: "lights", light: { sources: [...sourcesOf(scene), source] } }, scene, source.axis);
}

/// Removes a source. Without any left the model `lights` has nothing to show, and the cone takes its place.
export function removeSource(scene, index) {
  const sources = sourcesOf(scene).filter((_, i) => i !== index);
  if (sources.length > 0) return { light: { sources } };
  return { light: { sources: null }, ...(scene.model === "lights" ? { model: "cone" } : {}) };
}

export function changeSource(scene, index, fields) {
  return { light: { sources: sourcesOf(scene).map((source, i) => (i === index ? {...source, ...fields } : source)) } };
}

/// Adds to a patch what its model cannot be without: `lights` needs a source, and dos knows the cone alone.
/// @param axis  of the source that is made up where the scene has none, in the world
export function completed(patch, scene, axis) {
  const model = patch.model ?? scene.model, method = patch.method ?? scene.method;
  const result = {...patch };
  if (model === "lights" && (patch.light?.sources ?? sourcesOf(scene)).length === 0)
    result.light = {...result.light, sources: [newSource(axis)] };
  if (patch.model && patch.model !== "cone" && method === "dos") result.method = "light-volume";
  return result;
}

/// Returns the direction [right, up, towards the viewer] of a point on the ball. (x, y) is the place from the ball's
/// centre in radii, y upwards; a place outside of the ball is on its rim.
export function directionOnBall(x, y, behind) {
  const radius = Math.hypot(x, y);
  if (radius >= 1) return [x / radius, y / radius, 0];
  const z = Math.sqrt(1 - radius * radius);
  return [x, y, behind ? -z : z];
}

/// Returns where a direction is on the ball: { x, y, behind }.
export function placeOnBall(direction) {
  const [x, y, z] = normalize(direction);
  return { x, y, behind: z < 0 };
}
