// The two axes of the transfer function's plot: values to the right, which can be zoomed, and sigma_t upwards, linear
// or logarithmic. Positions are shares of the plot, 0 to 1.
// SPDX-License-Identifier: Apache-2.0
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

/// Sigma_t that is a share of the axis' top below this lies at the foot of a logarithmic axis.
const kDecades = 4;

export function shareOfSigma(sigma_t, top, logarithmic) {
  if (!logarithmic) return sigma_t / top;
  return sigma_t > 0 ? Math.max(0, 1 + Math.log10(sigma_t / top) / kDecades) : 0;
}
export function sigmaOfShare(share, top, logarithmic) {
  if (!logarithmic) return Math.max(0, share) * top;
  return share <= 0 ? 0 : top * 10 ** ((share - 1) * kDecades);
}

/// Returns the axis' top: a quarter above the largest point, so that points can be dragged up.
export const sigmaTop = (points) => 1.25 * Math.max(...points.map((point) => point.sigma_t)) || 1;

/// Zooms the range [low, high] by a factor around a value, within `whole`.
export function zoomedRange([low, high], factor, around, whole) {
  const least = (whole[1] - whole[0]) * 1e-4;
  const width = clamp((high - low) / factor, least, whole[1] - whole[0]);
  const start = around - ((around - low) / (high - low)) * width;
  const first = clamp(start, whole[0], whole[1] - width);
  return [first, first + width];
}

/// Moves the range by a distance, within `whole`.
export function movedRange([low, high], by, whole) {
  const first = clamp(low + by, whole[0], whole[1] - (high - low));
  return [first, first + high - low];
}

/// Returns a range that holds the histogram and all points, with a margin.
export function wholeRange(low, high, points) {
  const values = (points ?? []).map((point) => point.value);
  const first = Math.min(low, ...values), last = Math.max(high, ...values);
  const margin = 0.02 * (last - first || 1);
  return [first - margin, last + margin];
}

/// Returns round numbers between low and high, about `count` of them: 1, 2 or 5 times a power of ten apart.
export function ticks(low, high, count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= raw) * power;
  const result = [];
  for (let i = Math.ceil(low / step); i * step <= high; ++i) result.push(Number((i * step).toPrecision(12)));
  return result;
}

/// Returns a length of 1, 2 or 5 times a power of ten that is at most `longest`.
export function roundLength(longest) {
  const power = 10 ** Math.floor(Math.log10(longest));
  return [5, 2, 1].find((factor) => factor * power <= longest) * power;
}
