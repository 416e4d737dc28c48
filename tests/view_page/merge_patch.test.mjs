// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {applyPatch, composePatches, patchOf, replacingPatch, valueAt} from "../../tools/view/page/merge_patch.js";

// All examples of RFC 7396, appendix A.
const kExamples = [
  [{ a: "b" }, { a: "c" }, { a: "c" }],
  [{ a: "b" }, { b: "c" }, { a: "b", b: "c" }],
  [{ a: "b" }, { a: null }, {}],
  [{ a: "b", b: "c" }, { a: null }, { b: "c" }],
  [{ a: ["b"] }, { a: "c" }, { a: "c" }],
  [{ a: "c" }, { a: ["b"] }, { a: ["b"] }],
  [{ a: { b: "c" } }, { a: { b: "d", c: null } }, { a: { b: "d" } }],
  [{ a: [{ b: "c" }] }, { a: [1] }, { a: [1] }],
  [["a", "b"], ["c", "d"], ["c", "d"]],
  [{ a: "b" }, ["c"], ["c"]],
  [{ a: "foo" }, null, null],
  [{ a: "foo" }, "bar", "bar"],
  [{ e: null }, { a: 1 }, { e: null, a: 1 }],
  [[1, 2], { a: "b", c: null }, { a: "b" }],
  [{}, { a: { bb: { ccc: null } } }, { a: { bb: {} } }],
];

test("The examples of RFC 7396 hold", () => {
  for (const [target, patch, result] of kExamples) assert.deepEqual(applyPatch(target, patch), result);
});

test("A patch leaves its target as it was", () => {
  const target = { camera: { zoom: 1, pan: [0, 0] } };
  applyPatch(target, { camera: { zoom: 2, pan: null } });
  assert.deepEqual(target, { camera: { zoom: 1, pan: [0, 0] } });
});

test("Two patches joined do what they do one after the other", () => {
  const targets = [{}, { a: 1, b: { c: 2, d: 3 } }, { b: 5 }];
  const patches = [{ a: 2 }, { a: null }, { b: { c: null } }, { b: { c: 4, e: { f: 1 } } }, { b: null }, { b: [1] }];
  for (const target of targets)
    for (const first of patches)
      for (const second of patches) {
        const joined = composePatches(first, second);
        if (joined === undefined) continue;
        assert.deepEqual(applyPatch(target, joined), applyPatch(applyPatch(target, first), second));
      }
});

test("An object after its removal cannot be one patch", () => {
  assert.equal(composePatches({ b: null }, { b: { c: 1 } }), undefined);
});

test("Paths read and write fields", () => {
  assert.deepEqual(patchOf("occlusion.theta", 30), { occlusion: { theta: 30 } });
  assert.equal(valueAt({ occlusion: { theta: 30 } }, "occlusion.theta"), 30);
  assert.equal(valueAt({ occlusion: {} }, "occlusion.theta"), undefined);
  assert.equal(valueAt({}, "occlusion.theta"), undefined);
});

test("A replacing patch leaves nothing of the object before", () => {
  const before = { values: [1], gradients: [2], unit: "HU" }, next = { points: [] };
  assert.deepEqual(applyPatch({ transfer: before }, { transfer: replacingPatch(before, next) }), { transfer: next });
});
