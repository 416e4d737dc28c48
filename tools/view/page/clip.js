// Clip box and clip planes of a scene, as merge patches. A plane [a, b, c, d] keeps a x + b y + c z + d >= 0.
// SPDX-License-Identifier: Apache-2.0
import {dot, scale} from "./vector.js";

export const boxOf = (scene) => scene.clip?.box ?? null;
export const planesOf = (scene) => scene.clip?.planes ?? [];

/// Moves one face of the box. Faces do not pass each other.
/// @param end  0: the low face, 1: the high one
export function withFace(box, axis, end, value) {
  const other = box[1 - end][axis];
  const held = end === 0 ? Math.min(value, other) : Math.max(value, other);
  return box.map((corner, i) => (i === end ? corner.map((x, a) => (a === axis ? held : x)) : corner));
}

export const boxPatch = (box) => ({clip: {box}});
export const planesPatch = (planes) => ({clip: {planes: planes.length > 0 ? planes : null}});

/// Returns a plane through a point that cuts away what is nearer to the viewer.
export function facingPlane(forward, point) {
  const normal = forward.map((x) => Number(x.toFixed(4)));
  return [...normal, Number((-dot(normal, point)).toPrecision(6))];
}

/// Returns the plane of one axis through a point; what lies below it on the axis is cut away.
export function axisPlane(axis, point) {
  const normal = [0, 1, 2].map((a) => (a === axis ? 1 : 0));
  return [...normal, -point[axis]];
}

/// Returns the same plane with the other side kept.
export const flipped = (plane) => scale(plane, -1).map((x) => x + 0);

/// Returns how far a plane can be moved and still cut a box: the range of d.
export function planeOffsets(plane, [low, high]) {
  const reach = [0, 1, 2].map((a) => [plane[a] * low[a], plane[a] * high[a]].sort((x, y) => x - y));
  return [-reach.reduce((sum, [, most]) => sum + most, 0), -reach.reduce((sum, [least]) => sum + least, 0)];
}
