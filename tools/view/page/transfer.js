// Edits of a transfer function: a list of points { value, albedo, sigma_t } whose values ascend. Each edit returns a
// new list. Two equal values make a step, so that a point may be moved up to its neighbour but not past it.
// SPDX-License-Identifier: Apache-2.0
import {replacingPatch} from "./merge_patch.js";

const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

/// Returns the function's points, or null for a function of value and gradient magnitude, or none.
export function pointsOf(transfer) {
  return transfer && typeof transfer === "object" && Array.isArray(transfer.points) ? transfer.points : null;
}

/// Returns albedo and sigma_t at a value: linear between points, constant beyond the ends.
export function mediumAt(points, value) {
  if (value < points[0].value) return points[0];
  const at = points.findLastIndex((point) => point.value <= value);
  if (at === points.length - 1) return points[at];
  const a = points[at], b = points[at + 1];
  const t = (value - a.value) / (b.value - a.value);
  const mix = (x, y) => x + t * (y - x);
  return { albedo: a.albedo.map((x, i) => mix(x, b.albedo[i])), sigma_t: mix(a.sigma_t, b.sigma_t) };
}

/// Changes fields of one point. The value stays between those of its neighbours.
export function withPoint(points, index, fields) {
  const changed = {...points[index], ...fields };
  changed.value = clamp(changed.value, points[index - 1]?.value ?? -Infinity, points[index + 1]?.value ?? Infinity);
  changed.sigma_t = Math.max(0, changed.sigma_t);
  return points.map((point, i) => (i === index ? changed : point));
}

/// Adds a point. Its colour is that of the function there. @return { points, index of the new point }
export function withAdded(points, value, sigma_t) {
  const added = { value, albedo: [...mediumAt(points, value).albedo], sigma_t: Math.max(0, sigma_t) };
  const index = points.findLastIndex((point) => point.value <= value) + 1;
  return { points: [...points.slice(0, index), added, ...points.slice(index)], index };
}

/// Removes a point. The last one stays, since a function needs one.
export function withoutPoint(points, index) {
  return points.length > 1 ? points.filter((_, i) => i !== index) : points;
}

/// Moves all points along the axis of values.
export const shifted = (points, by) => points.map((point) => ({...point, value: point.value + by}));

/// Multiplies the extinction of all points.
export const scaled = (points, factor) => points.map((point) => ({...point, sigma_t: point.sigma_t * factor}));

/// Stretches the function to the window from low to high, as the option --window. Points of one value move to its
/// middle.
export function windowed(points, low, high) {
  const first = points[0].value, last = points.at(-1).value;
  const place = (value) => (last > first ? low + ((value - first) / (last - first)) * (high - low) : (low + high) / 2);
  return points.map((point) => ({...point, value: place(point.value) }));
}

/// Returns what has to be added to values of a function to get values of the grid: functions for CT are written in HU
/// or, for scans that store no negative numbers, in HU + 1000, and the library moves one to the other.
export function unitOffset(functionUnit, gridUnit) {
  const offset = (unit) => (unit === "HU" ? 0 : unit === "HU + 1000" ? 1000 : NaN);
  const difference = offset(gridUnit) - offset(functionUnit);
  return Number.isNaN(difference) ? 0 : difference;
}

/// Returns the patch that makes `points` the scene's function. Numbers are rounded to nine digits, far below a pixel.
export function pointsPatch(transfer, points) {
  const short = (x) => Number(x.toPrecision(9));
  const written = points.map(({ value, albedo, sigma_t }) => ({
                               value: short(value),
                               albedo: albedo.map((c) => clamp(short(c), 0, 1)),
                               sigma_t: short(sigma_t),
                             }));
  const next = { points: written };
  if (transfer?.unit) next.unit = transfer.unit;
  return { transfer: replacingPatch(transfer, next) };
}

/// Returns the patch of a function that was read from a file: ours, or the array that ParaView exports.
/// @throw Error  it is neither
export function loadedPatch(transfer, text) {
  const loaded = JSON.parse(text);
  if (Array.isArray(loaded)) return { transfer: loaded };
  if (loaded && (Array.isArray(loaded.points) || Array.isArray(loaded.values)))
    return { transfer: replacingPatch(transfer, loaded) };
  throw new Error("neither a transfer function nor a colour map of ParaView");
}
