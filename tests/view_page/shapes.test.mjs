// Functions of value and gradient magnitude as shapes.
// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {applyPatch} from "../../tools/view/page/merge_patch.js";
import * as shapes from "../../tools/view/page/shapes.js";

const plot = { low: 0, high: 100, most: 10 };
const red = [1, 0, 0], blue = [0, 0, 1];
const box = { kind: "rectangle", points: [[40, 2], [60, 8]], albedo: red, sigma_t: 0.5 };
const wedge = { kind: "triangle", points: [[50, 1], [80, 9], [20, 9]], albedo: blue, sigma_t: 0.25 };

// The lattice as the library reads it: bilinear between its lines, constant beyond.
function sigmaAt({ values, gradients, sigma_t }, value, gradient) {
  const cell = (axis, x) => {
    const i = Math.min(Math.max(axis.findLastIndex((line) => line <= x), 0), axis.length - 2);
    return [i, Math.min(1, Math.max(0, (x - axis[i]) / (axis[i + 1] - axis[i])))];
  };
  const [i, u] = cell(values, value), [j, v] = cell(gradients, gradient);
  const at = (a, b) => sigma_t[(j + b) * values.length + i + a];
  return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
}

const isAscending = (axis) => axis.every((x, i) => i === 0 || x > axis[i - 1]);

test("A rectangle is in its lattice exactly along its axes, rim and all", () => {
  const lattice = shapes.latticeOf([box], plot);
  assert.ok(isAscending(lattice.values) && isAscending(lattice.gradients));
  assert.equal(lattice.albedo.length, lattice.values.length * lattice.gradients.length);
  for (let value = 0; value <= 100; value += 0.7) {
    const expected = box.sigma_t * shapes.weightAt(box, value, 5);
    assert.ok(Math.abs(sigmaAt(lattice, value, 5) - expected) < 1e-5, `at ${value}`);
  }
  assert.equal(sigmaAt(lattice, 50, 9), 0);
});

test("A rectangle that stands on gradient 0 has no rim there", () => {
  const standing = {...box, points: [[40, 0], [60, 5]] };
  assert.equal(shapes.weightAt(standing, 50, 0), 1);
  assert.equal(shapes.weightAt(box, 50, 2), 0);
});

test("A triangle is in its lattice within the distance of its lines", () => {
  const lattice = shapes.latticeOf([wedge], plot);
  assert.ok(Math.abs(sigmaAt(lattice, 50, 6) - wedge.sigma_t) < 1e-9);
  assert.equal(sigmaAt(lattice, 20, 1), 0);
  let worst = 0;
  for (let value = 0; value <= 100; ++value)
    for (let gradient = 0; gradient <= 10; gradient += 0.25)
      worst = Math.max(worst, Math.abs(sigmaAt(lattice, value, gradient) - wedge.sigma_t * shapes.weightAt(wedge, value, gradient)));
  // The rim of 0.12 is about as wide as the lines are apart: between two of them bilinear interpolation is off by less
  // than half of the whole.
  assert.ok(worst < 0.5 * wedge.sigma_t, `off by ${worst}`);
});

test("Where shapes overlap extinctions add up, and the colour is their mean by extinction", () => {
  const both = shapes.mediumOf([box, {...box, albedo: blue, sigma_t: 1.5 }], 50, 5, plot);
  assert.equal(both.sigma_t, 2);
  assert.deepEqual(both.albedo, [0.25, 0, 0.75]);
});

test("Places without a shape have the colour of the nearest one, so that rims are not dark", () => {
  const far = {...box, points: [[5, 2], [15, 8]], albedo: blue };
  assert.deepEqual(shapes.mediumOf([box, far], 62, 5, plot), { sigma_t: 0, albedo: red });
  assert.deepEqual(shapes.mediumOf([box, far], 20, 5, plot), { sigma_t: 0, albedo: blue });
  assert.deepEqual(shapes.mediumOf([], 20, 5, plot), { sigma_t: 0, albedo: [1, 1, 1] });
});

test("No shapes are a function that shows nothing, and many have no more lines than a renderer does well with", () => {
  const none = shapes.latticeOf([], plot);
  assert.deepEqual(none.values, [0, 100]);
  assert.ok(none.sigma_t.every((sigma_t) => sigma_t === 0));
  const many = Array.from({ length: 30 }, (_, i) => ({...wedge, points: wedge.points.map(([v, g]) => [v + i / 3, g]) }));
  const lattice = shapes.latticeOf(many, plot);
  assert.ok(lattice.values.length <= 64 && isAscending(lattice.values));
  assert.ok(isAscending(shapes.mergedLines([50, 50 + 1e-9, 50, 99.99999], 0, 100)));
});

test("The patch replaces points as a whole", () => {
  const scene = { transfer: { points: [{ value: 0, albedo: red, sigma_t: 1 }], unit: "HU" } };
  const { transfer } = applyPatch(scene, shapes.shapesPatch(scene.transfer, [box], plot));
  assert.deepEqual(Object.keys(transfer).sort(), ["albedo", "gradients", "sigma_t", "values"]);
});

test("Corners of a rectangle do not pass each other, and all stay in the plot", () => {
  const dragged = shapes.withCorner(box, 0, [90, 9.5], plot);
  const [[v0, g0], [v1, g1]] = shapes.boundsOf(dragged);
  assert.ok(v0 < 60 && v1 === 60 && g0 < 8 && g1 === 8);
  assert.deepEqual(shapes.boundsOf(shapes.withCorner(box, 2, [500, 50], plot)), [[40, 2], [100, 10]]);
  assert.deepEqual(shapes.boundsOf(shapes.withCorner(box, 1, [70, 1], plot)), [[40, 1], [70, 8]]);
  assert.deepEqual(shapes.withCorner(wedge, 1, [-5, 4], plot).points[1], [0, 4]);
  assert.deepEqual(shapes.boundsOf(shapes.movedShape(box, [1000, -1000], plot)), [[80, 0], [100, 6]]);
});

test("A place is inside of what is drawn around it", () => {
  assert.ok(shapes.isInside(box, 41, 7.9) && !shapes.isInside(box, 39, 5));
  assert.ok(shapes.isInside(wedge, 50, 8) && !shapes.isInside(wedge, 25, 3));
  assert.ok(!shapes.isInside({...wedge, points: [[1, 1], [2, 2], [3, 3]] }, 2, 2));
});

test("Shapes come back with their lattice, also when it has been to the server", () => {
  const memory = new shapes.ShapeMemory(2);
  const lattice = shapes.latticeOf([box, wedge], plot);
  assert.equal(memory.find(lattice), null);
  memory.keep(lattice, [box, wedge]);
  const served = JSON.parse(JSON.stringify(lattice));
  assert.deepEqual(memory.find(served), [box, wedge]);
  memory.keep(shapes.latticeOf([box], plot), [box]);
  memory.keep(shapes.latticeOf([wedge], plot), [wedge]);
  assert.equal(memory.find(JSON.parse(JSON.stringify(lattice))), null);  // two are kept
});
