// What kind of control a scene field gets, from the server's table of fields.
// SPDX-License-Identifier: Apache-2.0
import {valueAt} from "./merge_patch.js";

/// Fields that a panel of their own shows.
export const kOwnPanel = new Set(["light.ambient", "light.background"]);
const kSlowSlider = 40;  // a range of so many times its low end is easier to set in equal ratios

/// Returns whether the scene has a use for a field now: an orbit has no eye, and `footprint` belongs to dos.
export function isShown(field, scene) {
  if (kOwnPanel.has(field.path) || valueAt(scene, field.path) === undefined) return false;
  return !field.onlyOf?.length || field.onlyOf.includes(scene.method);
}

/// Returns the groups of fields in the order of the table: [{ name, fields }].
export function grouped(fields) {
  const groups = new Map();
  for (const field of fields) groups.set(field.group, [...(groups.get(field.group) ?? []), field]);
  return [...groups].map(([name, list]) => ({ name, fields: list }));
}

/// Returns the label of "occlusion.perspectiveCorrection": "perspective correction".
export function labelOf(field) {
  return field.path.split(".").at(-1).replace(/[A-Z]/g, (letter) => " " + letter.toLowerCase());
}

/// Returns how a slider's place, 0 to 1000, maps to a field's values; null where a range has no ends.
export function sliderOf(field) {
  const { low, high, kind } = field;
  if (low === null || high === null || low === undefined || high === undefined || high - low > 1e6) return null;
  const whole = kind === "integer";
  const logarithmic = low > 0 && high / low > kSlowSlider;
  // The upper end of a range of real numbers is mostly excluded (an angle below 90), so that the slider ends before it.
  const end = whole ? high : high - (high - low) / 1000;
  const multiple = field.multipleOf ?? 1;
  const rounded = (x) => (whole ? Math.round(x / multiple) * multiple : Number(x.toPrecision(4)));
  const toValue = (place) =>
      rounded(logarithmic ? low * (end / low) ** (place / 1000) : low + (end - low) * (place / 1000));
  const toPlace = (value) =>
      1000 * (logarithmic ? Math.log(value / low) / Math.log(end / low) : (value - low) / (end - low));
  return { toValue, toPlace };
}

/// Reads what was typed into a number's field. @return undefined where it is no number
export function readNumber(text, whole) {
  const value = Number(String(text).trim().replace(",", "."));
  if (String(text).trim() === "" || !Number.isFinite(value)) return undefined;
  return whole ? Math.round(value) : value;
}
