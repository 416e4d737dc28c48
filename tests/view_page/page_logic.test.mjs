// Colours, lights, clipping, fields of the table, messages and words.
// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import * as clip from "../../tools/view/page/clip.js";
import * as colour from "../../tools/view/page/colour.js";
import * as fields from "../../tools/view/page/fields.js";
import {parseFrame} from "../../tools/view/page/frame_message.js";
import * as lights from "../../tools/view/page/lights.js";
import {applyPatch} from "../../tools/view/page/merge_patch.js";
import {retryDelayMs} from "../../tools/view/page/retry.js";
import * as words from "../../tools/view/page/words.js";

test("Every colour of 8 bits comes back from linear light", () => {
  for (let i = 0; i < 256; ++i) {
    const hex = "#" + i.toString(16).padStart(2, "0").repeat(3);
    assert.equal(colour.hexOfLinear(colour.linearOfHex(hex)), hex);
  }
});

test("Mid grey of sRGB is 21 % of linear light", () => {
  assert.ok(Math.abs(colour.toLinear(0.5) - 0.2140411) < 1e-7);  // IEC 61966-2-1
});

test("Radiance above 1 is split into colour and strength", () => {
  assert.deepEqual(colour.splitRadiance([4, 2, 0]), { colour: [1, 0.5, 0], strength: 4 });
  assert.deepEqual(colour.splitRadiance([0.5, 0, 0]), { colour: [0.5, 0, 0], strength: 1 });
});

test("A light brings the model that looks at it, and the last one takes it away", () => {
  const scene = { model: "cone", method: "dos", light: {} };
  const lit = applyPatch(scene, lights.addSource(scene, lights.newSource([0, 0, 1])));
  assert.deepEqual([lit.model, lit.method, lit.light.sources.length], ["lights", "light-volume", 1]);
  const dark = applyPatch(lit, lights.removeSource(lit, 0));
  assert.deepEqual([dark.model, dark.light.sources], ["cone", undefined]);
});

test("The model lights gets a source where there is none, and keeps those that are there", () => {
  const scene = { model: "cone", method: "ordinates", light: {} };
  assert.equal(lights.completed({ model: "lights" }, scene, [0, 0, 1]).light.sources.length, 1);
  const lit = {...scene, light: { sources: [{ type: "environment" }] } };
  assert.deepEqual(lights.completed({ model: "lights" }, lit, [0, 0, 1]), { model: "lights" });
  assert.deepEqual(lights.completed({ sampling: { spacing: 1 } }, scene, [0, 0, 1]), { sampling: { spacing: 1 } });
});

test("A change of one light leaves the others", () => {
  const scene = { light: { sources: [{ type: "environment", file: "sky.exr" }, lights.newSource([0, 0, 1])] } };
  const { sources } = applyPatch(scene, lights.changeSource(scene, 1, { theta: 20 })).light;
  assert.deepEqual(sources[0], scene.light.sources[0]);
  assert.equal(sources[1].theta, 20);
});

test("Places on the ball and directions undo each other, on both sides", () => {
  for (const [x, y] of [[0, 0], [0.5, -0.3], [0.1, 0.9]])
    for (const behind of [false, true]) {
      const place = lights.placeOnBall(lights.directionOnBall(x, y, behind));
      assert.ok(Math.hypot(place.x - x, place.y - y) < 1e-12);
      assert.equal(place.behind, behind);
    }
  assert.deepEqual(lights.directionOnBall(3, 4, false), [0.6, 0.8, 0]);
});

test("Faces of the clip box do not pass each other", () => {
  const box = [[0, 0, 0], [10, 10, 10]];
  assert.deepEqual(clip.withFace(box, 1, 0, 4), [[0, 4, 0], [10, 10, 10]]);
  assert.deepEqual(clip.withFace(box, 1, 0, 40), [[0, 10, 0], [10, 10, 10]]);
  assert.deepEqual(clip.withFace(box, 2, 1, -4), [[0, 0, 0], [10, 10, 0]]);
  assert.deepEqual(applyPatch({ clip: { box } }, clip.boxPatch(null)), { clip: {} });
});

test("A plane that faces the viewer keeps what is behind it", () => {
  const plane = clip.facingPlane([0, 1, 0], [5, 6, 7]);
  const side = (plane_, [x, y, z]) => plane_[0] * x + plane_[1] * y + plane_[2] * z + plane_[3];
  assert.equal(side(plane, [5, 6, 7]), 0);
  assert.ok(side(plane, [0, 9, 0]) > 0);
  assert.ok(side(clip.flipped(plane), [0, 9, 0]) < 0);
  assert.equal(side(clip.axisPlane(2, [5, 6, 7]), [1, 1, 7]), 0);
});

test("A plane's slider goes from all kept to nothing kept", () => {
  const [low, high] = clip.planeOffsets([1, -2, 0, 0], [[0, 0, 0], [10, 20, 30]]);
  assert.deepEqual([low, high], [-10, 40]);
});

test("Fields that the scene has no use for are hidden", () => {
  const scene = { method: "dos", camera: { azimuth: 0 }, light: { ambient: [1, 1, 1] }, occlusion: { footprint: 3 } };
  assert.ok(fields.isShown({ path: "camera.azimuth" }, scene));
  assert.ok(!fields.isShown({ path: "camera.eye" }, scene));
  assert.ok(!fields.isShown({ path: "light.ambient" }, scene));
  assert.ok(fields.isShown({ path: "occlusion.footprint", onlyOf: ["dos"] }, scene));
  assert.ok(!fields.isShown({ path: "occlusion.footprint", onlyOf: ["ordinates"] }, scene));
});

test("Groups keep the order of the table", () => {
  const table = [{ path: "a", group: "Camera" }, { path: "b", group: "Light" }, { path: "c", group: "Camera" }];
  assert.deepEqual(
      fields.grouped(table).map(({ name, fields: list }) => [name, list.length]), [["Camera", 2], ["Light", 1]]);
  assert.equal(fields.labelOf({ path: "occlusion.perspectiveCorrection" }), "perspective correction");
});

test("Sliders reach both ends of whole numbers and stay below an open end of others", () => {
  const whole = fields.sliderOf({ low: 1, high: 1024, kind: "integer" });
  assert.deepEqual([whole.toValue(0), whole.toValue(1000)], [1, 1024]);
  assert.ok(Math.abs(whole.toPlace(32) - 500) < 1e-9);
  const angle = fields.sliderOf({ low: 0, high: 90, kind: "number" });
  assert.equal(angle.toValue(0), 0);
  assert.ok(angle.toValue(1000) < 90);
  assert.equal(fields.sliderOf({ low: 0, high: null, kind: "number" }), null);
});

test("Numbers are read with point or comma, and nothing else is a number", () => {
  assert.equal(fields.readNumber(" 1,5 ", false), 1.5);
  assert.equal(fields.readNumber("1e-3", false), 1e-3);
  assert.equal(fields.readNumber("2.6", true), 3);
  for (const text of ["", "abc", "1 2", "Infinity"]) assert.equal(fields.readNumber(text, false), undefined);
});

test("A frame is header and bytes, and one that is cut short is refused", () => {
  const text = new TextEncoder().encode("{\"frame\":7,\"mime\":\"image/png\"}");
  const message = new Uint8Array(4 + text.length + 2);
  new DataView(message.buffer).setUint32(0, text.length, true);
  message.set(text, 4);
  message.set([1, 2], 4 + text.length);
  const { header, bytes } = parseFrame(message.buffer);
  assert.equal(header.frame, 7);
  assert.deepEqual([...bytes], [1, 2]);
  assert.throws(() => parseFrame(message.buffer.slice(0, 10)), /shorter/);
  assert.throws(() => parseFrame(new ArrayBuffer(2)), /too short/);
});

test("Waits between tries grow and end at 15 seconds", () => {
  assert.deepEqual([0, 1, 2, 9].map(retryDelayMs), [500, 1000, 2000, 15000]);
});

test("The state of a picture is said in few words", () => {
  const status = { samples: 8, error: 0.00612, draft: false, done: false, paused: false, text: "" };
  assert.equal(words.statusWords(status), "8 samples, error 0.0061");
  assert.equal(words.statusWords({...status, samples: 1, error: null }), "1 sample");
  assert.equal(words.statusWords({...status, draft: true }), "draft");
  assert.equal(words.statusWords({...status, done: true }), "done: error 0.0061");
  assert.equal(words.statusWords({...status, paused: true }), "paused: 8 samples, error 0.0061");
  assert.equal(words.statusWords({...status, text: "done: error 0.004" }), "done: error 0.004");
});

test("A probe says value, unit, place and depth, or that there is nothing", () => {
  const probe = { value: 1123.4, world: [10.25, 33, 80], depth: 312.2 };
  assert.equal(words.probeWords(probe, "HU"), "value 1123 HU at (10.25, 33, 80), depth 312.2");
  assert.equal(words.probeWords({ value: null, world: null, depth: null }, "HU"), "nothing here");
});

test("The chart begins anew with each picture", () => {
  const at = (ms, samples, error, draft = false) => ({ ms, samples, error, draft });
  let history = [];
  for (const status of [at(100, 1, null), at(200, 2, 0.1), at(400, 4, 0.05), at(450, 4, 0.05)])
    history = words.withErrorPoint(history, status);
  assert.deepEqual(history.map((point) => point.samples), [2, 4]);
  assert.deepEqual(words.withErrorPoint(history, at(90, 1, 0.3)).map((point) => point.samples), [1]);
  assert.deepEqual(words.withErrorPoint(history, at(500, 1, null, true)), []);
});

test("After a file was saved the next name is proposed", () => {
  assert.equal(words.nextName("picture.png"), "picture-2.png");
  assert.equal(words.nextName("picture-2.png"), "picture-3.png");
  assert.equal(words.nextName("a-b.9.exr"), "a-b.9-2.exr");
  assert.equal(words.nextName("bare"), "bare-2");
});

test("A slider of multiples gives multiples", () => {
  const slider = fields.sliderOf({ low: 8, high: 256, kind: "integer", multipleOf: 8 });
  for (const place of [0, 333, 777, 1000]) assert.equal(slider.toValue(place) % 8, 0);
});
