// Colours: displayed sRGB (what a colour picker gives) and linear light (what a scene holds).
// SPDX-License-Identifier: Apache-2.0
const clamp01 = (x) => Math.min(1, Math.max(0, x));

/// One channel, IEC 61966-2-1.
export const toLinear = (s) => (s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4);
export const toSrgb = (l) => (l <= 0.0031308 ? 12.92 * l : 1.055 * l ** (1 / 2.4) - 0.055);

/// Returns "#rrggbb" of a linear colour. Channels above 1 are shown as 1.
export function hexOfLinear(rgb) {
  return "#" + rgb.map((c) => Math.round(255 * toSrgb(clamp01(c))).toString(16).padStart(2, "0")).join("");
}

/// Returns the linear colour of "#rrggbb", to six digits, which is far below one step of 8 bits.
export function linearOfHex(hex) {
  return [1, 3, 5].map((at) => Number(toLinear(parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(6)));
}

/// Splits a radiance into a colour that a picker can show and a strength of 1 or more.
export function splitRadiance(rgb) {
  const strength = Math.max(1, ...rgb);
  return { colour: rgb.map((c) => c / strength), strength };
}
