// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import * as camera from "../../tools/view/page/camera.js";
import {applyPatch} from "../../tools/view/page/merge_patch.js";
import {add, cross, dot, length, scale, subtract} from "../../tools/view/page/vector.js";

const kDegree = Math.PI / 180;
const kNear = 1e-9;  // rounding of some tens of operations on numbers of some hundreds, in double precision

const near = (a, b, within = kNear) => {
  const list = [a].flat(), other = [b].flat();
  assert.equal(list.length, other.length);
  list.forEach((x, i) => assert.ok(Math.abs(x - other[i]) < within, `${a} is not near ${b}`));
};

const frame = {
  up: [0, 0, -1],
  front: [0, -1, 0],
  centre: [98, 102, 72],
  radius: 180
};
const orbit = {
  projection: "perspective",
  azimuth: 30,
  elevation: 15,
  upAxis: "auto",
  frontAxis: "auto",
  zoom: 1.5,
  pan: [0.1, -0.2],
  fov: 27,
  near: 0,
  size: [640, 400]
};
const parallel = {
  ...orbit,
  projection: "orthographic",
  size: [400, 640]
};
// A camera that is placed where an orbit's is.
const placed = (base) => applyPatch({ camera: base }, camera.rollBy(base, camera.resolveCamera(base, frame), 0)).camera;
const kCameras =
    [["orbit", orbit], ["parallel orbit", parallel], ["placed", placed(orbit)], ["placed parallel", placed(parallel)]];
const resolve = (base) => camera.resolveCamera(base, frame);
const patched = (base, patch) => applyPatch({ camera: base }, patch).camera;

// Returns where a point of the world is in the picture: from the centre to the right and up, in heights.
function project(base, point) {
  const resolved = resolve(base), axes = camera.viewAxes(resolved), offset = subtract(point, resolved.eye);
  const height = base.projection === "perspective" ?
      2 * Math.tan(0.5 * resolved.fov * kDegree) * dot(offset, axes.forward) :
      resolved.viewHeight;
  return [dot(offset, axes.right) / height, dot(offset, axes.up) / height];
}
// The point of the world at a place of the picture, at the depth of the target.
function targetPoint(base, [x, y]) {
  const resolved = resolve(base), axes = camera.viewAxes(resolved), height = camera.heightAtTarget(base, resolved);
  return add(resolved.lookAt, add(scale(axes.right, x * height), scale(axes.up, y * height)));
}

// The numbers are what `umbrick render --stats` of the bundled head says of --azimuth 30 --elevation 15 --zoom 1.02.
test("An orbit resolves to the library's camera", () => {
  const base = {...orbit, pan: [0, 0], zoom: 1.02, fov: 30, size: [400, 400] };
  const radius = 0.5 * Math.hypot(229.5 - 5.4, 229.5 + 21.6, 139.5 - 1.5);
  const resolved =
      camera.resolveCamera(base, { up: [0, 0, 1], front: [0, -1, 0], centre: [112.05, 125.55, 69], radius });
  near(resolved.fov, 29.43754240768321, 1e-9);
  near(resolved.up, [-0.12940952255126034, 0.2241438680420134, 0.9659258262890683]);
  const towards = scale(subtract(resolved.eye, resolved.lookAt), 1 / length(subtract(resolved.eye, resolved.lookAt)));
  const offset = [392.86662793294727 - 112.05, -360.83866719003026 - 125.55, 219.48917735172853 - 69];
  near(towards, scale(offset, 1 / length(offset)));
});

test("The frame of an orbit is found from the camera that it resolves to", () => {
  for (const base of [orbit, parallel, {...orbit, elevation: -90, size: [300, 700] }]) {
    const found = camera.orbitFrame(base, resolve(base));
    for (const name of ["up", "front", "centre", "radius"]) near(found[name], frame[name], 1e-7);
  }
});

test("To place an orbit's camera changes nothing that is seen", () => {
  for (const base of [orbit, parallel]) {
    const free = placed(base);
    for (const name of ["azimuth", "elevation", "upAxis", "frontAxis", "zoom", "pan"]) assert.ok(!(name in free), name);
    for (const point of [[98, 102, 72], [0, 0, 0], [150, 30, 100]]) near(project(free, point), project(base, point));
  }
});

test("Panning moves the target's plane with the pointer", () => {
  for (const [name, base] of kCameras) {
    const point = targetPoint(base, [0.1, 0.2]);
    const moved = patched(base, camera.panBy(base, resolve(base), 0.3, 0.15));
    near(project(moved, point), [0.4, 0.05], 1e-7, name);
  }
});

test("What is under the pointer stays there while the wheel zooms, and gets larger", () => {
  for (const [, base] of kCameras) {
    const at = [0.3, -0.2], point = targetPoint(base, at), beside = targetPoint(base, [0.4, -0.2]);
    const zoomed = patched(base, camera.zoomBy(base, resolve(base), 1.25, ...at));
    near(project(zoomed, point), at, 1e-7);
    near(project(zoomed, beside)[0] - at[0], 0.125, 1e-7);
  }
});

test("A drag to the right turns what is in front to the right, a drag down turns it down", () => {
  for (const [, base] of kCameras) {
    // A point between target and eye.
    const resolved = resolve(base), point = add(resolved.lookAt, scale(subtract(resolved.eye, resolved.lookAt), 0.2));
    const before = project(base, point);
    const right = project(patched(base, camera.orbitBy(base, resolved, 0.05, 0)), point);
    const down = project(patched(base, camera.orbitBy(base, resolved, 0, 0.05)), point);
    assert.ok(right[0] > before[0] + 0.01);
    assert.ok(down[1] < before[1] - 0.01);
  }
});

test("Turning keeps the distance to the target, and elevation ends at the poles", () => {
  for (const [, base] of kCameras) {
    const resolved = resolve(base), turned = resolve(patched(base, camera.orbitBy(base, resolved, 0.3, -0.1)));
    near(length(subtract(turned.eye, turned.lookAt)), length(subtract(resolved.eye, resolved.lookAt)), 1e-7);
  }
  assert.equal(camera.orbitBy(orbit, resolve(orbit), 0, 3).camera.elevation, 90);
  assert.equal(camera.orbitBy({...orbit, azimuth: -170 }, resolve(orbit), 0.1, 0).camera.azimuth, 172);
});

test("Looking about keeps the eye, and the view follows the pointer", () => {
  const base = placed(orbit), resolved = resolve(base), point = targetPoint(base, [0, 0]);
  const looked = patched(base, camera.lookBy(base, resolved, 0.1, 0.05));
  near(looked.eye, base.eye);
  const [x, y] = project(looked, point);
  assert.ok(x > 0.08 && x < 0.12 && y < -0.03 && y > -0.07, `${x}, ${y}`);
});

test("Rolling turns the picture by the angle, counter-clockwise", () => {
  for (const [, base] of kCameras) {
    const point = targetPoint(base, [0.3, 0]);
    const rolled = patched(base, camera.rollBy(base, resolve(base), 0.5));
    near(project(rolled, point), [0.3 * Math.cos(0.5), 0.3 * Math.sin(0.5)], 1e-7);
  }
});

test("Flying moves eye and target alike", () => {
  const base = placed(orbit), resolved = resolve(base), axes = camera.viewAxes(resolved);
  const flown = patched(base, camera.flyBy(base, resolved, [1, 2, 3]));
  const step = add(add(axes.right, scale(axes.up, 2)), scale(axes.forward, 3));
  near(subtract(flown.eye, base.eye), step);
  near(subtract(flown.lookAt, base.lookAt), step);
  const flat = placed(parallel);
  assert.ok(patched(flat, camera.flyBy(flat, resolve(flat), [0, 0, 5])).viewHeight < flat.viewHeight);
});

test("A placed camera keeps its size in the picture when the projection changes", () => {
  const base = placed(orbit), point = targetPoint(base, [0.2, 0.1]);
  const flat = patched(base, camera.toggleProjection(base, resolve(base)));
  near(project(flat, point), [0.2, 0.1], 1e-7);
  const back = patched(flat, camera.toggleProjection(flat, resolve(flat)));
  near(back.eye, base.eye, 1e-7);
});

test("The way back to the first camera leaves no field of the present one but the size", () => {
  for (const [, base] of kCameras)
    for (const [, first] of kCameras) {
      const now = {...base, size: [123, 45] };
      assert.deepEqual(patched(now, camera.cameraBack(now, first)), {...first, size: [123, 45] });
    }
});

test("An axis view of a placed camera is an orbit again", () => {
  const view = patched(placed(orbit), camera.orbitTo(placed(orbit), { azimuth: 90, elevation: 0 }));
  assert.ok(camera.isOrbit(view));
  assert.deepEqual([view.azimuth, view.zoom, view.pan], [90, 1, [0, 0]]);
  assert.ok(!("viewHeight" in view));
});

test("View and world frames of a direction undo each other", () => {
  const axes = camera.viewAxes(resolve(orbit)), direction = [0.3, -0.5, 0.8];
  near(camera.toView(axes, camera.toWorld(axes, direction)), direction);
  near(camera.toWorld(axes, [0, 0, 1]), scale(axes.forward, -1));
  near(cross(axes.right, axes.up), scale(axes.forward, -1));
});
