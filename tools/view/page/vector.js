// Vectors of three numbers as arrays.
// SPDX-License-Identifier: Apache-2.0
export const add = (a, b) => a.map((x, i) => x + b[i]);
export const subtract = (a, b) => a.map((x, i) => x - b[i]);
export const scale = (a, factor) => a.map((x) => x * factor);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const length = (a) => Math.hypot(...a);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/// Returns a vector of length 1; the zero vector stays.
export const normalize = (a) => (length(a) > 0 ? scale(a, 1 / length(a)) : a);
/// Turns a vector around an axis of length 1, counter-clockwise as seen from the axis' tip; the angle is in radians.
export function rotate(a, axis, angle) {
  const cosine = Math.cos(angle);
  return add(add(scale(a, cosine), scale(cross(axis, a), Math.sin(angle))), scale(axis, dot(axis, a) * (1 - cosine)));
}
