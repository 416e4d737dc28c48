// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {applyPatch} from "../../tools/view/page/merge_patch.js";
import * as axes from "../../tools/view/page/plot_axes.js";
import * as transfer from "../../tools/view/page/transfer.js";

const point = (value, sigma_t, albedo = [0.5, 0.5, 0.5]) => ({ value, sigma_t, albedo });
const points = [point(0, 0, [0, 0, 0]), point(100, 2, [1, 0.5, 0]), point(300, 1)];

test("Between points the medium is linear, beyond them constant", () => {
  assert.deepEqual(transfer.mediumAt(points, 50), { albedo: [0.5, 0.25, 0], sigma_t: 1 });
  assert.equal(transfer.mediumAt(points, -5).sigma_t, 0);
  assert.equal(transfer.mediumAt(points, 500).sigma_t, 1);
});

test("At a step the second point holds", () => {
  const step = [point(10, 1), point(10, 5), point(20, 5)];
  assert.equal(transfer.mediumAt(step, 10).sigma_t, 5);
  assert.equal(transfer.mediumAt(step, 9.99).sigma_t, 1);
});

test("A point is moved up to its neighbours, not past them, and sigma_t not below 0", () => {
  assert.equal(transfer.withPoint(points, 1, { value: 400 })[1].value, 300);
  assert.equal(transfer.withPoint(points, 1, { value: -10 })[1].value, 0);
  assert.equal(transfer.withPoint(points, 1, { sigma_t: -1 })[1].sigma_t, 0);
  assert.equal(transfer.withPoint(points, 2, { value: 1e6 })[2].value, 1e6);
  assert.equal(points[1].value, 100);
});

test("An added point has the function's colour and stands in order", () => {
  const { points: more, index } = transfer.withAdded(points, 50, 3);
  assert.equal(index, 1);
  assert.deepEqual(more[1], { value: 50, albedo: [0.5, 0.25, 0], sigma_t: 3 });
  assert.equal(transfer.withAdded(points, -5, 1).index, 0);
  assert.equal(transfer.withAdded(points, 900, 1).index, 3);
});

test("The last point cannot be removed", () => {
  assert.equal(transfer.withoutPoint(points, 0).length, 2);
  assert.equal(transfer.withoutPoint([points[0]], 0).length, 1);
});

test("A window moves both ends and keeps proportions; a step moves to its middle", () => {
  assert.deepEqual(transfer.windowed(points, 10, 40).map((p) => p.value), [10, 20, 40]);
  assert.deepEqual(transfer.windowed([point(5, 0), point(5, 1)], 10, 20).map((p) => p.value), [15, 15]);
});

test("Functions in HU are moved to volumes in HU + 1000 and back", () => {
  assert.equal(transfer.unitOffset("HU", "HU + 1000"), 1000);
  assert.equal(transfer.unitOffset("HU + 1000", "HU"), -1000);
  assert.equal(transfer.unitOffset("HU", "HU"), 0);
  assert.equal(transfer.unitOffset("", "HU"), 0);
  assert.equal(transfer.unitOffset("HU", "K"), 0);
});

test("The patch of points replaces a lattice as a whole and keeps the unit", () => {
  const lattice = { unit: "HU", values: [0], gradients: [0], albedo: [[0, 0, 0]], sigma_t: [1] };
  const scene = applyPatch({ transfer: lattice }, transfer.pointsPatch(lattice, points));
  assert.deepEqual(scene.transfer, { points, unit: "HU" });
});

test("A file of ParaView becomes the function as it is, one of ours replaces it, others are refused", () => {
  assert.deepEqual(transfer.loadedPatch({ points }, "[{\"RGBPoints\": []}]"), { transfer: [{ RGBPoints: [] }] });
  assert.deepEqual(
      transfer.loadedPatch({ unit: "HU", points }, "{\"points\": []}"), { transfer: { unit: null, points: [] } });
  assert.throws(() => transfer.loadedPatch({ points }, "{\"camera\": {}}"), /neither/);
  assert.throws(() => transfer.loadedPatch({ points }, "nonsense"), SyntaxError);
});

test("Heights of sigma_t map back, on both axes", () => {
  for (const logarithmic of [false, true])
    for (const share of [0.1, 0.5, 1]) {
      const back = axes.shareOfSigma(axes.sigmaOfShare(share, 7, logarithmic), 7, logarithmic);
      assert.ok(Math.abs(back - share) < 1e-12);
    }
  assert.equal(axes.sigmaOfShare(-0.1, 7, true), 0);
  assert.equal(axes.shareOfSigma(0, 7, true), 0);
});

test("Zooming keeps the value under the pointer and ends at the whole range", () => {
  const [low, high] = axes.zoomedRange([0, 100], 2, 25, [0, 100]);
  assert.deepEqual([low, high], [12.5, 62.5]);
  assert.deepEqual(axes.zoomedRange([12.5, 62.5], 0.01, 25, [0, 100]), [0, 100]);
  assert.deepEqual(axes.movedRange([10, 30], -50, [0, 100]), [0, 20]);
});

test("Ticks are round numbers, whatever the range", () => {
  assert.deepEqual(axes.ticks(0, 100, 5), [0, 20, 40, 60, 80, 100]);
  assert.deepEqual(axes.ticks(-0.013, 0.021, 4), [-0.01, 0, 0.01, 0.02]);
  assert.equal(axes.roundLength(7.9), 5);
  assert.equal(axes.roundLength(0.023), 0.02);
});
