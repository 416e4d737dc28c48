// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import {resolveCamera} from "../../tools/view/page/camera.js";
import {EditPacer} from "../../tools/view/page/edit_pacer.js";
import {Session} from "../../tools/view/page/session.js";

const frame = {
  up: [0, 0, 1],
  front: [0, -1, 0],
  centre: [1, 2, 3],
  radius: 10
};
const scene = {
  camera: { projection: "perspective", azimuth: 0, elevation: 0, zoom: 1, pan: [0, 0], fov: 30, size: [100, 100] },
  transfer: { points: [{ value: 0, albedo: [1, 1, 1], sigma_t: 1 }] },
  sampling: { spacing: 1 }
};
const message = (of) => (
    { type: "scene", scene: of, canUndo: false, canRedo: false, command: "", camera: resolveCamera(of.camera, frame) });

function opened() {
  const sent = [];
  const send = (sent_) => sent.push(sent_);
  const session = new Session(send, new EditPacer(send, () => {}, () => 0));
  session.receive(message(scene));
  return { session, sent };
}

test("An edit holds at once and is sent", () => {
  const { session, sent } = opened();
  session.edit({ sampling: { spacing: 2 } });
  assert.equal(session.scene.sampling.spacing, 2);
  assert.deepEqual(sent[0].patch, { sampling: { spacing: 2 } });
  assert.equal(sent[0].moving, false);
});

test("While something is dragged, older scenes of the server do not pull it back", () => {
  const { session } = opened();
  const drag = session.drag("test");
  drag.edit({ sampling: { spacing: 2 } });
  drag.edit({ sampling: { spacing: 3 } });
  session.receive(message({...scene, sampling: { spacing: 2 } }));
  assert.equal(session.scene.sampling.spacing, 3);
  drag.end();
  session.receive(message({...scene, sampling: { spacing: 3.5 } }));
  assert.equal(session.scene.sampling.spacing, 3.5);
});

test("An edit that the server refuses is taken back, also after a drag", () => {
  const { session } = opened();
  session.edit({ sampling: { spacing: -1 } });
  session.receive({ type: "error", message: "sampling.spacing: ..." });
  assert.equal(session.scene.sampling.spacing, 1);
  const drag = session.drag("test");
  drag.edit({ sampling: { spacing: -1 } });
  session.receive({ type: "error", message: "sampling.spacing: ..." });
  assert.equal(session.scene.sampling.spacing, -1);
  drag.end();
  assert.equal(session.scene.sampling.spacing, 1);
});

test("A drag's edits have one step, and two drags have two", () => {
  const { session, sent } = opened();
  for (const spacing of [2, 3]) {
    const drag = session.drag("test");
    drag.edit({ sampling: { spacing } });
    drag.edit({ sampling: { spacing: spacing + 0.5 } });
    drag.end();
  }
  const steps = sent.filter((each) => each.type === "edit").map((each) => each.step);
  // The third and the fourth edit were joined, since no picture had been shown.
  assert.equal(steps.length, 3);
  assert.equal(steps[0], steps[1]);
  assert.notEqual(steps[1], steps[2]);
});

test("A click without a move sends nothing", () => {
  const { session, sent } = opened();
  session.drag("test").end();
  assert.equal(sent.length, 0);
});

test("A preset keeps the function shown until the server says what it is", () => {
  const { session, sent } = opened();
  session.edit({ transfer: "ct-bone" });
  assert.deepEqual(session.scene.transfer, scene.transfer);
  assert.deepEqual(sent[0].patch, { transfer: "ct-bone" });
});

test("The camera of the next edit is known without asking", () => {
  const { session } = opened();
  session.edit({ camera: { azimuth: 90 } });
  const { eye, lookAt } = session.view().resolved;
  lookAt.forEach((x, i) => assert.ok(Math.abs(x - frame.centre[i]) < 1e-9));
  // At azimuth 90 the eye is at up x front, which is +x here.
  assert.ok(eye[0] > 30 && Math.abs(eye[1] - 2) < 1e-9);
});

test("Undo goes out after the edits before it", () => {
  const { session, sent } = opened();
  session.edit({ sampling: { spacing: 2 } });
  session.edit({ sampling: { spacing: 3 } });
  session.command({ type: "undo" });
  assert.deepEqual(sent.map((each) => each.type), ["edit", "edit", "undo"]);
});
