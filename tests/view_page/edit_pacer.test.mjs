// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {EditPacer} from "../../tools/view/page/edit_pacer.js";

// A pacer with a clock and animation frames that the test moves on.
function bench() {
  const sent = [];
  let due = [], time = 0;
  const pacer = new EditPacer((message) => sent.push(message), (step) => due.push(step), () => time);
  const frame = (ms = 16) => {
    time += ms;
    const steps = due;
    due = [];
    steps.forEach((step) => step());
  };
  return { pacer, sent, frame };
}

test("Edits of one animation frame become one message, with the last values", () => {
  const { pacer, sent, frame } = bench();
  for (let i = 1; i <= 5; ++i) pacer.edit({ camera: { azimuth: i } }, "drag", true);
  assert.equal(sent.length, 1);
  frame();
  assert.equal(sent.length, 2);
  assert.deepEqual(sent[1], { type: "edit", patch: { camera: { azimuth: 5 } }, moving: true, step: "drag" });
});

test("No third edit goes out before a picture has been shown", () => {
  const { pacer, sent, frame } = bench();
  for (let i = 1; i <= 6; ++i) {
    pacer.edit({ zoom: i }, "drag", true);
    frame();
  }
  assert.equal(sent.length, 2);
  pacer.pictureShown();
  assert.equal(sent.length, 3);
  assert.deepEqual(sent[2].patch, { zoom: 6 });
});

test("An edit that changes no pixel does not stop those after it", () => {
  const { pacer, sent, frame } = bench();
  for (let i = 1; i <= 3; ++i) {
    pacer.edit({ zoom: i }, "drag", true);
    frame();
  }
  assert.equal(sent.length, 2);
  frame(1000);
  assert.equal(sent.length, 3);
});

test("The last edit of a drag goes out before its end, without waiting", () => {
  const { pacer, sent } = bench();
  pacer.edit({ zoom: 1 }, "drag", true);
  pacer.edit({ zoom: 2 }, "drag", true);
  pacer.rest();
  assert.deepEqual(sent.map((message) => message.patch?.zoom ?? message.type), [1, 2, "rest"]);
});

test("Edits of two steps stay two, in their order", () => {
  const { pacer, sent, frame } = bench();
  pacer.edit({ zoom: 1 }, "a", false);
  pacer.edit({ zoom: 2 }, "b", false);
  pacer.edit({ zoom: 3 }, "c", false);
  frame();
  pacer.flush();
  assert.deepEqual(sent.map((message) => [message.step, message.patch.zoom]), [["a", 1], ["b", 2], ["c", 3]]);
});

test("What no single patch can say is sent as two", () => {
  const { pacer, sent } = bench();
  pacer.edit({ a: 1 }, "s", true);
  pacer.edit({ clip: null }, "s", true);
  pacer.edit({ clip: { planes: [] } }, "s", true);
  pacer.flush();
  assert.deepEqual(sent.map((message) => message.patch), [{ a: 1 }, { clip: null }, { clip: { planes: [] } }]);
});

test("After a lost connection nothing of before is sent", () => {
  const { pacer, sent, frame } = bench();
  pacer.edit({ zoom: 1 }, "drag", true);
  pacer.edit({ zoom: 2 }, "drag", true);
  pacer.reset();
  frame();
  pacer.flush();
  assert.equal(sent.length, 1);
});
