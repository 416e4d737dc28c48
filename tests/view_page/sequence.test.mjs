// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {FrameAsker, FrameNumbers} from "../../tools/view/page/sequence.js";

// Frames 0 4 8, 16 20, 40 of every fourth; 12 and 24 to 36 are missing.
const gaps = new FrameNumbers({ ranges: [[0, 8], [16, 20], [40, 40]], step: 4 });
const all = [0, 4, 8, 16, 20, 40];

test("Frames are counted over gaps, and their ends are kept", () => {
  assert.equal(gaps.count, all.length);
  assert.deepEqual(all.map((_, i) => gaps.at(i)), all);
  assert.deepEqual([gaps.at(-1), gaps.at(99)], [0, 40]);
  assert.equal(gaps.words, "0-40:4");
  assert.equal(new FrameNumbers({ ranges: [[-2, 3]], step: 1 }).words, "-2-3");
});

test("The nearest frame is that of a look at all of them", () => {
  for (let number = -9; number < 60; ++number) {
    const far = all.map((each) => Math.abs(each - number));
    assert.equal(gaps.nearest(number), far.indexOf(Math.min(...far)), `of ${number}`);
  }
});

test("Steps go to the other end where there is a loop, and else stay", () => {
  assert.deepEqual([gaps.beside(8, 1, false), gaps.beside(16, -1, false)], [16, 8]);
  assert.deepEqual([gaps.beside(40, 1, true), gaps.beside(0, -1, true)], [0, 40]);
  assert.deepEqual([gaps.beside(40, 1, false), gaps.beside(0, -1, false)], [40, 0]);
});

test("A slider asks once an animation frame, for its last place, and its end goes out at once", () => {
  const sent = [], due = [];
  const asker = new FrameAsker((message) => sent.push(message), (step) => due.push(step));
  for (const number of [1, 2, 3]) asker.drag(number);
  assert.equal(sent.length, 0);
  due.shift()();
  assert.deepEqual(sent.splice(0), [{ type: "sequence", number: 3, moving: true }]);
  asker.drag(4);
  asker.ask(5);
  due.shift()();
  assert.deepEqual(sent, [{ type: "sequence", number: 5, moving: false }]);
  assert.equal(due.length, 0);
});
