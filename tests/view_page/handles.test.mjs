// What is dragged over the picture and over the histogram: faces of the clip box and lines of surfaces; and the words of
// the chart and of a comparison.
// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {project, travelTo, viewAxes} from "../../tools/view/page/camera.js";
import * as handles from "../../tools/view/page/clip_handles.js";
import {comparedPictures} from "../../tools/view/page/compare_panel.js";
import {decades} from "../../tools/view/page/error_chart.js";
import {nearestSurface} from "../../tools/view/page/surface_plot.js";
import {chartWords, withErrorPoint} from "../../tools/view/page/words.js";

const resolved = { eye: [0, -10, 0], lookAt: [0, 0, 0], up: [0, 0, 1], fov: 60, viewHeight: 8 };
const viewOf = (projection, placed = resolved) => ({ camera: { projection }, resolved: placed, axes: viewAxes(placed) });
const views = [viewOf("perspective"), viewOf("orthographic"), viewOf("perspective", {...resolved, eye: [7, -8, 5], up: [0.2, 0, 1] })];
const box = [[-1, -2, -3], [1, 2, 3]];

test("Points are seen where a camera of the library shows them", () => {
  const [perspective, orthographic] = views;
  assert.deepEqual(project(perspective, [0, 0, 0]), [0, 0]);
  // At a distance of 10 the picture is 2 * 10 * tan(30 degrees) high.
  const [x, y] = project(perspective, [1, 0, 2]);
  const height = 20 * Math.tan(Math.PI / 6);
  assert.ok(Math.abs(x - 1 / height) < 1e-12 && Math.abs(y - 2 / height) < 1e-12);
  assert.equal(project(perspective, [0, -11, 0]), null);
  assert.deepEqual(project(orthographic, [1, 5, 2]), [1 / 8, 2 / 8]);
});

test("A point that follows the pointer along a direction is found again", () => {
  for (const view of views)
    for (const direction of [[2, 0, 0], [0, 0, -3], [1, 1, 0.5]])
      for (const t of [-0.4, 0, 0.7]) {
        const place = project(view, direction.map((d) => t * d));
        assert.ok(Math.abs(travelTo(view, [0, 0, 0], direction, place) - t) < 1e-6);
      }
  // Towards the eye nothing is seen of the way, and nothing moves.
  assert.equal(travelTo(views[1], [0, 0, 0], [0, 1, 0], [0.3, 0.3]), 0);
});

test("A box has twelve edges, and six faces of which the eye sees those that look at it", () => {
  const edges = handles.edgesOf(box);
  assert.equal(edges.length, 12);
  for (const [a, b] of edges) assert.equal(a.filter((x, i) => x !== b[i]).length, 1);
  const seen = handles.facesOf(box, views[2]).filter((face) => !face.away);
  assert.deepEqual(seen.map(({ axis, end }) => [axis, end]), [[0, 1], [1, 0], [2, 1]]);
  assert.deepEqual(handles.facesOf(box, views[1]).filter((face) => !face.away).map(({ axis }) => axis), [1]);
});

test("A dragged face goes where the pointer is, and ends at the volume", () => {
  const view = views[2], face = handles.facesOf(box, view).find(({ axis, end }) => axis === 2 && end === 1);
  const bounds = [[-4, -4, -4], [4, 4, 4]];
  assert.ok(Math.abs(handles.draggedFace(view, face, project(view, [0, 0, 1.5]), bounds) - 1.5) < 1e-4);
  assert.equal(handles.draggedFace(view, face, project(view, [0, 0, 9]), bounds), 4);
});

test("The nearest line within reach is taken, of lines on each other the upper one", () => {
  const surfaces = [{ value: 10 }, { value: 20 }, { value: 20 }];
  assert.equal(nearestSurface(surfaces, 12, 3), 0);
  assert.equal(nearestSurface(surfaces, 19, 3), 2);
  assert.equal(nearestSurface(surfaces, 15, 3), -1);
});

test("The chart says error, time and target, and that it is done", () => {
  const status = { ms: 2300, error: 0.0041, standardError: 0.004, samples: 16, draft: false, targetError: 0.004 };
  const history = withErrorPoint([], status);
  assert.equal(chartWords(history, status), "error 0.0041 after 2.3 s, 16 samples, target 0.004");
  assert.equal(
      chartWords(history, {...status, done: true, targetError: 0.005 }), "done: error 0.0041 after 2.3 s, 16 samples");
  assert.equal(chartWords([], status), "No error is known yet");
  assert.equal(history[0].standardError, 0.004);
  assert.deepEqual(decades(0.004, 0.03), [-3, -1]);
  assert.deepEqual(decades(0.01, 0.01), [-2, -1]);
});

test("A comparison has three pictures, and the scale of their difference", () => {
  const pictures = comparedPictures({ top: 0.02, pictures: { drawn: "AA==", reference: "BB==", difference: "CC==" } });
  assert.deepEqual(pictures.map(({ title }) => title), ["drawn", "reference", "difference"]);
  assert.equal(pictures[1].source, "data:image/png;base64,BB==");
  assert.match(pictures[2].help, /0\.02/);
});
