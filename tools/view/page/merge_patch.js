// JSON merge patches (RFC 7396): applying one, joining two into one, and reading and writing fields by paths such as
// "occlusion.theta".
// SPDX-License-Identifier: Apache-2.0

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/// Returns what a patch makes of a value. Neither of the two is changed.
export function applyPatch(target, patch) {
  if (!isObject(patch)) return patch;
  const result = isObject(target) ? {...target } : {};
  for (const [key, value] of Object.entries(patch)) {
    if (value === null)
      delete result[key];
    else
      result[key] = applyPatch(result[key], value);
  }
  return result;
}

/// Returns one patch that does what `first` and then `second` do, or undefined where no single patch can: an object
/// after null means "remove all of it, then add this", which merge patches have no words for.
export function composePatches(first, second) {
  if (!isObject(second)) return second;
  if (!isObject(first)) return undefined;
  const result = {...first };
  for (const [key, value] of Object.entries(second)) {
    if (!(key in result)) {
      result[key] = value;
      continue;
    }
    const both = composePatches(result[key], value);
    if (both === undefined) return undefined;
    result[key] = both;
  }
  return result;
}

/// Returns the patch {"a": {"b": value}} of the path "a.b".
export function patchOf(path, value) { return path.split(".").reduceRight((inner, key) => ({ [key]: inner }), value); }

/// Returns the field of a path, or undefined where the object has none.
export function valueAt(object, path) {
  return path.split(".").reduce((inner, key) => (isObject(inner) ? inner[key] : undefined), object);
}

/// Returns a patch that replaces an object as a whole: fields that only `current` has are removed.
export function replacingPatch(current, next) {
  if (!isObject(current) || !isObject(next)) return next;
  const removed = Object.keys(current).filter((key) => !(key in next));
  return {...Object.fromEntries(removed.map((key) => [key, null])), ...next };
}
