// Draws a transfer function over the histogram of the volume's values: bars of log counts, the curve of sigma_t filled
// with the colours that it scatters, and its points.
// SPDX-License-Identifier: Apache-2.0
import {hexOfLinear} from "./colour.js";
import {shareOfSigma, ticks} from "./plot_axes.js";
import {mediumAt} from "./transfer.js";
import {shortNumber} from "./words.js";

const kColours = {
  bars: "#454c5a",
  grid: "#363c47",
  text: "#aeb5c1",
  curve: "#f2f4f8",
  chosen: "#ffb347"
};
const kFoot = 30;    // pixels below the plot for the colours and the numbers
const kBand = 8;     // of them for the colours
const kMargin = 10;  // at the other sides, so that points at the ends can be gripped

/// Returns the plot's place in a canvas of so many CSS pixels.
export const plotArea = (width, height) =>
    ({left: kMargin, top: kMargin, width: width - 2 * kMargin, height: height - kMargin - kFoot});

/// Makes a canvas as fine as the screen and clears it. @return its context, in CSS pixels
export function startPlot(canvas) {
  const ratio = window.devicePixelRatio || 1;
  Object.assign(
      canvas, { width: Math.round(canvas.clientWidth * ratio), height: Math.round(canvas.clientHeight * ratio) });
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  context.font = "11px system-ui, sans-serif";
  return context;
}

/// Draws the histogram as bars of log counts over a range of values.
export function drawBars(context, area, { histogram, low, high }, range) {
  const most = Math.log1p(Math.max(...histogram)), width = (high - low) / histogram.length;
  const perValue = area.width / (range[1] - range[0]);
  context.fillStyle = kColours.bars;
  histogram.forEach((count, i) => {
    const x = area.left + (low + i * width - range[0]) * perValue;
    const height = most > 0 ? (Math.log1p(count) / most) * area.height : 0;
    context.fillRect(x, area.top + area.height - height, Math.max(1, width * perValue - 0.5), height);
  });
}

/// Draws round numbers below the plot.
export function drawNumbers(context, area, range) {
  context.fillStyle = kColours.text;
  context.textAlign = "center";
  context.textBaseline = "bottom";
  for (const value of ticks(range[0], range[1], Math.max(2, area.width / 70))) {
    const x = area.left + ((value - range[0]) / (range[1] - range[0])) * area.width;
    context.fillRect(x, area.top + area.height + kBand + 2, 1, 4);
    const text = shortNumber(value), half = context.measureText(text).width / 2;
    if (x + half < area.left + area.width + kMargin) context.fillText(text, x, area.top + area.height + kFoot);
  }
}

// Fills what is below the curve, and the band under it, column by column: between points of a logarithmic axis a line
// of sigma_t is no line in the plot, and steps stay sharp.
function drawFunction(context, area, points, range, top, logarithmic) {
  const foot = area.top + area.height;
  context.lineWidth = 1.5;
  context.strokeStyle = kColours.curve;
  const curve = new Path2D();
  for (let i = 0; i <= area.width; ++i) {
    const medium = mediumAt(points, range[0] + (i / area.width) * (range[1] - range[0]));
    const height = Math.min(1, shareOfSigma(medium.sigma_t, top, logarithmic)) * area.height;
    context.fillStyle = hexOfLinear(medium.albedo);
    context.globalAlpha = 0.45;
    context.fillRect(area.left + i, foot - height, 1, height);
    context.globalAlpha = 1;
    context.fillRect(area.left + i, foot + 2, 1, kBand - 2);
    if (i === 0)
      curve.moveTo(area.left, foot - height);
    else
      curve.lineTo(area.left + i, foot - height);
  }
  context.stroke(curve);
}

/// Returns whether a place lies over the part of the axis that is shown.
export const isOver = (area, [x]) => x > area.left - 1 && x < area.left + area.width + 1;

function drawPoints(context, area, places, points, chosen) {
  places.forEach(([x, y], i) => {
    if (!isOver(area, [x, y])) return;
    context.beginPath();
    context.arc(x, y, i === chosen ? 7 : 5.5, 0, 2 * Math.PI);
    context.fillStyle = hexOfLinear(points[i].albedo);
    context.fill();
    context.lineWidth = i === chosen ? 3 : 1.5;
    context.strokeStyle = i === chosen ? kColours.chosen : kColours.curve;
    context.stroke();
  });
}

/// @param plot  { points, places, chosen, range, top, logarithmic, volume }; points may be null
export function drawTransferPlot(canvas, plot) {
  const width = canvas.clientWidth, height = canvas.clientHeight;
  const context = startPlot(canvas), area = plotArea(width, height);
  context.save();
  context.beginPath();
  context.rect(area.left, 0, area.width, height);
  context.clip();
  drawBars(context, area, plot.volume, plot.range);
  drawNumbers(context, area, plot.range);
  if (plot.points) drawFunction(context, area, plot.points, plot.range, plot.top, plot.logarithmic);
  context.restore();
  context.fillStyle = kColours.grid;
  context.fillRect(area.left, area.top + area.height, area.width, 1);
  if (plot.points) drawPoints(context, area, plot.places, plot.points, plot.chosen);
}
