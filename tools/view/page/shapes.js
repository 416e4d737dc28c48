// Functions of value and gradient magnitude as shapes: rectangles and triangles that have a colour and an extinction.
// They are drawn into the lattice of a scene's transfer function, where they overlap their extinctions add up.
//
// A shape is { kind: "rectangle" | "triangle", points: [[value, gradient], ...], albedo, sigma_t }. A rectangle has two
// opposite corners. Its extinction falls to 0 over a narrow rim, so that no edge is harder than the voxels are.
// SPDX-License-Identifier: Apache-2.0
import {replacingPatch} from "./merge_patch.js";

const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
const kRim = 0.12;          // of a shape's size
const kTriangleLines = 10;  // of the lattice across a triangle
const kMostLines = 64;      // of the lattice along each axis: rays look at each one that they cross

/// Returns [[low value, low gradient], [high value, high gradient]] around a shape.
export function boundsOf({ points }) {
  const of = (axis, pick) => pick(...points.map((point) => point[axis]));
  return [[of(0, Math.min), of(1, Math.min)], [of(0, Math.max), of(1, Math.max)]];
}

// A rectangle that stands on the axis of gradients has no rim there: regions of one value have gradient 0.
function rectangleWeight(shape, value, gradient) {
  const [[v0, g0], [v1, g1]] = boundsOf(shape);
  const rims = [kRim * (v1 - v0), kRim * (g1 - g0)];
  const across = Math.min(value - v0, v1 - value) / rims[0];
  const up = Math.min(g0 <= 0 ? Infinity : gradient - g0, g1 - gradient) / rims[1];
  return clamp(Math.min(across, up), 0, 1);
}

/// Returns the barycentric coordinates of a place in a triangle.
export function barycentric([[ax, ay], [bx, by], [cx, cy]], x, y) {
  const area = (by - cy) * (ax - cx) + (cx - bx) * (ay - cy);
  if (area === 0) return [-1, -1, -1];  // a triangle without extent holds nothing
  const a = ((by - cy) * (x - cx) + (cx - bx) * (y - cy)) / area;
  const b = ((cy - ay) * (x - cx) + (ax - cx) * (y - cy)) / area;
  return [a, b, 1 - a - b];
}

/// Returns how much of a shape's extinction is at a place: 1 inside, 0 outside, between over the rim.
export function weightAt(shape, value, gradient) {
  if (shape.kind === "rectangle") return rectangleWeight(shape, value, gradient);
  return clamp(Math.min(...barycentric(shape.points, value, gradient)) / kRim, 0, 1);
}

/// Returns whether a place lies in a shape, rim included.
export function isInside(shape, value, gradient) {
  if (shape.kind === "triangle") return Math.min(...barycentric(shape.points, value, gradient)) >= 0;
  const [[v0, g0], [v1, g1]] = boundsOf(shape);
  return value >= v0 && value <= v1 && gradient >= g0 && gradient <= g1;
}

// Lines of the lattice that a shape needs along an axis: a rectangle is exact with its corners and rims.
function linesOf(shape, axis) {
  const [low, high] = boundsOf(shape).map((corner) => corner[axis]);
  if (shape.kind === "rectangle") {
    const rim = kRim * (high - low);
    return [low, low + rim, high - rim, high];
  }
  return Array.from({ length: kTriangleLines + 1 }, (_, i) => low + (i / kTriangleLines) * (high - low));
}

/// Returns ascending lines with neither two that are nearly equal nor more than a renderer does well with.
export function mergedLines(lines, low, high) {
  const least = (high - low) * 1e-3;
  const sorted = [low, high, ...lines.map((x) => clamp(x, low, high))].sort((a, b) => a - b);
  const kept = sorted.filter((x, i) => i === 0 || x - sorted[i - 1] > least || x === high);
  const distinct = [];
  for (const x of kept) {
    const short = Number(x.toPrecision(7));
    if (distinct.length === 0 || short - distinct.at(-1) > least) distinct.push(short);
  }
  if (distinct.length <= kMostLines) return distinct;
  return Array.from({ length: kMostLines }, (_, i) => Number((low + (i / (kMostLines - 1)) * (high - low)).toPrecision(7)));
}

// How far a place is from a shape, in sizes of the plot.
function distanceTo(shape, value, gradient, { low, high, most }) {
  const [[v0, g0], [v1, g1]] = boundsOf(shape);
  const across = Math.max(v0 - value, 0, value - v1) / (high - low), up = Math.max(g0 - gradient, 0, gradient - g1) / most;
  return Math.hypot(across, up);
}

const short = (x) => Number(x.toPrecision(6));

/// Returns the medium of the shapes at a place. Where there is none, the colour is that of the nearest shape: colours
/// are interpolated between places of the lattice, and would else be darker at rims.
export function mediumOf(shapes, value, gradient, plot) {
  const weights = shapes.map((shape) => weightAt(shape, value, gradient) * shape.sigma_t);
  const sigma_t = weights.reduce((sum, weight) => sum + weight, 0);
  if (sigma_t > 0)
    return {
      sigma_t: short(sigma_t),
      albedo: [0, 1, 2].map((c) => short(shapes.reduce((sum, { albedo }, i) => sum + weights[i] * albedo[c], 0) / sigma_t))
    };
  const near = shapes.map((shape) => distanceTo(shape, value, gradient, plot));
  return { sigma_t: 0, albedo: shapes[near.indexOf(Math.min(...near))]?.albedo ?? [1, 1, 1] };
}

/// Returns the lattice of shapes, as scenes have it. @param plot  { low, high, most }: the ends of both axes
export function latticeOf(shapes, plot) {
  const values = mergedLines(shapes.flatMap((shape) => linesOf(shape, 0)), plot.low, plot.high);
  const gradients = mergedLines(shapes.flatMap((shape) => linesOf(shape, 1)), 0, plot.most);
  const media = gradients.flatMap((gradient) => values.map((value) => mediumOf(shapes, value, gradient, plot)));
  return { values, gradients, albedo: media.map(({ albedo }) => albedo), sigma_t: media.map(({ sigma_t }) => sigma_t) };
}

/// Returns the patch that makes shapes the scene's function.
export const shapesPatch = (transfer, shapes, plot) => ({transfer: replacingPatch(transfer, latticeOf(shapes, plot))});

/// Moves one corner. Corners stay in the plot; those of a rectangle do not pass each other.
export function withCorner(shape, index, [value, gradient], { low, high, most }) {
  const place = [clamp(value, low, high), clamp(gradient, 0, most)];
  if (shape.kind === "triangle")
    return {...shape, points: shape.points.map((point, i) => (i === index ? place : point)) };
  const least = [(high - low) * 4e-3, most * 8e-3];
  const corners = cornersOf(shape), held = corners[(index + 2) % 4];
  const points = [0, 1].map((axis) => {
    const moved = corners[index][axis] >= held[axis] ? Math.max(place[axis], held[axis] + least[axis]) : Math.min(place[axis], held[axis] - least[axis]);
    return [moved, held[axis]];
  });
  return {...shape, points: [[points[0][0], points[1][0]], [points[0][1], points[1][1]]] };
}

/// Returns the corners that can be dragged: four of a rectangle, counter-clockwise from the lowest, three of a triangle.
export function cornersOf(shape) {
  if (shape.kind === "triangle") return shape.points;
  const [[v0, g0], [v1, g1]] = boundsOf(shape);
  return [[v0, g0], [v1, g0], [v1, g1], [v0, g1]];
}

/// Moves a shape, within the plot.
export function movedShape(shape, [byValue, byGradient], { low, high, most }) {
  const [[v0, g0], [v1, g1]] = boundsOf(shape);
  const across = clamp(byValue, low - v0, high - v1), up = clamp(byGradient, -g0, most - g1);
  return {...shape, points: shape.points.map(([v, g]) => [v + across, g + up]) };
}

/// Returns a shape to begin with, in the upper half of the values, where most volumes have what is looked for.
export function newShape(kind, { low, high, most }, sigma_t) {
  const at = (v, g) => [low + v * (high - low), g * most];
  const points = kind === "rectangle" ? [at(0.5, 0), at(0.9, 0.45)] : [at(0.5, 0.02), at(0.8, 0.7), at(0.2, 0.7)];
  const albedo = kind === "rectangle" ? [0.9, 0.75, 0.5] : [0.85, 0.35, 0.25];
  return { kind, points, albedo, sigma_t };
}

/// Remembers which shapes made which lattice, so that they come back with undo. A lattice that the page has not made has
/// none.
export class ShapeMemory {
  constructor(most = 400) { Object.assign(this, { most_: most, known_: new Map() }); }
  keep(lattice, shapes) {
    const key = this.keyOf_(lattice);
    this.last_ = undefined;
    this.known_.delete(key);
    this.known_.set(key, shapes);
    if (this.known_.size > this.most_) this.known_.delete(this.known_.keys().next().value);
  }
  /// @return null where the lattice is of somebody else
  find(lattice) {
    if (lattice === this.last_) return this.found_;
    this.last_ = lattice;
    this.found_ = this.known_.get(this.keyOf_(lattice)) ?? null;
    return this.found_;
  }
  keyOf_({ values, gradients, albedo, sigma_t }) { return JSON.stringify([values, gradients, albedo, sigma_t]); }
}
