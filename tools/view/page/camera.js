// Moves of the camera, as merge patches of the scene.
//
// A scene's camera is either an orbit (angles around the volume) or placed by eye, lookAt and up. The server resolves
// both to the same: { eye, lookAt, up }. From one resolved orbit its axes, centre and radius follow, so that the page
// knows the camera of the next edit without asking.
// SPDX-License-Identifier: Apache-2.0
import {replacingPatch} from "./merge_patch.js";
import {add, cross, dot, length, normalize, rotate, scale, subtract} from "./vector.js";

const kDegree = Math.PI / 180;
const kOrbitFields = ["azimuth", "elevation", "upAxis", "frontAxis", "zoom", "pan"];
const kPlacedFields = ["eye", "lookAt", "up", "viewHeight"];
const kMostZoom = 1000;

const nulls = (names) => Object.fromEntries(names.map((name) => [name, null]));
const aspectOf = (camera) => camera.size[0] / camera.size[1];
const isPerspective = (camera) => camera.projection !== "orthographic";
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

export const isOrbit = (camera) => camera.eye === undefined;

// The distance of eye and target in an orbit around a sphere of radius 1, before any zoom.
function orbitDistance(camera) {
  const aspect = Math.min(1, aspectOf(camera));
  if (!isPerspective(camera)) return 2;
  return 1 / Math.sin(Math.atan(Math.tan(0.5 * camera.fov * kDegree) * aspect));
}

// The height of an orbit's picture at its target, in world units, before any zoom.
function orbitHeight(camera, radius) {
  if (!isPerspective(camera)) return (2 * radius) / Math.min(1, aspectOf(camera));
  return 2 * radius * orbitDistance(camera) * Math.tan(0.5 * camera.fov * kDegree);
}

/// Returns what an orbit turns around: { up, front, centre, radius }, from an orbit and what the server made of it.
/// The formulas are those of orbitCamera in the library, solved for what is given there.
export function orbitFrame(camera, resolved) {
  const sa = Math.sin(camera.azimuth * kDegree), ca = Math.cos(camera.azimuth * kDegree);
  const se = Math.sin(camera.elevation * kDegree), ce = Math.cos(camera.elevation * kDegree);
  const offset = subtract(resolved.eye, resolved.lookAt);
  const towardsEye = normalize(offset), eyeUp = normalize(resolved.up);
  const up = add(scale(towardsEye, se), scale(eyeUp, ce));
  const level = subtract(scale(towardsEye, ce), scale(eyeUp, se));
  const front = subtract(scale(level, ca), scale(cross(up, level), sa));
  const radius = length(offset) / orbitDistance(camera);
  const height = orbitHeight(camera, radius) / camera.zoom;
  const right = cross(scale(towardsEye, -1), eyeUp);
  const shift = add(scale(right, -height * camera.pan[0]), scale(eyeUp, -height * camera.pan[1]));
  return { up, front, centre: subtract(resolved.lookAt, shift), radius };
}

/// Returns { eye, lookAt, up, fov, viewHeight } of a scene's camera; fov is that of the picture, after any zoom.
/// @param frame  of orbitFrame, for an orbit
export function resolveCamera(camera, frame) {
  if (!isOrbit(camera))
    return { eye: camera.eye, lookAt: camera.lookAt, up: camera.up, fov: camera.fov, viewHeight: camera.viewHeight };
  const sa = Math.sin(camera.azimuth * kDegree), ca = Math.cos(camera.azimuth * kDegree);
  const se = Math.sin(camera.elevation * kDegree), ce = Math.cos(camera.elevation * kDegree);
  const side = cross(frame.up, frame.front);
  const level = add(scale(side, sa), scale(frame.front, ca));
  const towardsEye = add(scale(level, ce), scale(frame.up, se));
  const up = add(scale(level, -se), scale(frame.up, ce));
  const height = orbitHeight(camera, frame.radius) / camera.zoom;
  const right = cross(scale(towardsEye, -1), up);
  const shift = add(scale(right, -height * camera.pan[0]), scale(up, -height * camera.pan[1]));
  const lookAt = add(frame.centre, shift);
  return {
    eye: add(lookAt, scale(towardsEye, frame.radius * orbitDistance(camera))),
    lookAt,
    up,
    fov: (2 / kDegree) * Math.atan(Math.tan(0.5 * camera.fov * kDegree) / camera.zoom),
    viewHeight: height,
  };
}

/// Returns the axes of the view, as cameraFrame of the library.
export function viewAxes(resolved) {
  const forward = normalize(subtract(resolved.lookAt, resolved.eye));
  const right = normalize(cross(forward, resolved.up));
  return { right, up: cross(right, forward), forward };
}

/// Returns the height of what the picture shows at the target, in world units.
export function heightAtTarget(camera, resolved) {
  if (!isPerspective(camera)) return resolved.viewHeight;
  return 2 * length(subtract(resolved.eye, resolved.lookAt)) * Math.tan(0.5 * resolved.fov * kDegree);
}

const orbitPatch = (fields) => ({ camera: fields });
// The patch that places a camera; from an orbit it also takes the orbit's fields away.
function placedPatch(camera, resolved) {
  const { eye, lookAt, up, fov, viewHeight } = resolved;
  const placed = { eye, lookAt, up };
  if (isPerspective(camera))
    placed.fov = fov;
  else
    placed.viewHeight = viewHeight;
  return { camera: isOrbit(camera) ? {...nulls(kOrbitFields), ...placed } : placed };
}

/// Turns the camera around its target. dx and dy are in heights of the picture, to the right and down.
export function orbitBy(camera, resolved, dx, dy) {
  if (isOrbit(camera)) {
    const azimuth = ((((camera.azimuth - 180 * dx + 180) % 360) + 360) % 360) - 180;
    return orbitPatch({ azimuth, elevation: clamp(camera.elevation + 180 * dy, -90, 90) });
  }
  const axes = viewAxes(resolved);
  const turn = (v) => rotate(rotate(v, axes.up, -Math.PI * dx), axes.right, -Math.PI * dy);
  const offset = turn(subtract(resolved.eye, resolved.lookAt));
  return placedPatch(camera, {...resolved, eye: add(resolved.lookAt, offset), up: turn(axes.up) });
}

/// Turns the view around the eye, as one who looks about.
export function lookBy(camera, resolved, dx, dy) {
  const axes = viewAxes(resolved);
  const turn = (v) => rotate(rotate(v, axes.up, dx * resolved.fov * kDegree), axes.right, dy * resolved.fov * kDegree);
  const lookAt = add(resolved.eye, turn(subtract(resolved.lookAt, resolved.eye)));
  return placedPatch(camera, {...resolved, lookAt, up: turn(axes.up) });
}

/// Moves the thing in the picture by dx to the right and dy down, in heights of the picture.
export function panBy(camera, resolved, dx, dy) {
  if (isOrbit(camera)) return orbitPatch({ pan: [camera.pan[0] + dx, camera.pan[1] - dy] });
  const axes = viewAxes(resolved), height = heightAtTarget(camera, resolved);
  const shift = add(scale(axes.right, -dx * height), scale(axes.up, dy * height));
  return placedPatch(camera, {...resolved, eye: add(resolved.eye, shift), lookAt: add(resolved.lookAt, shift) });
}

/// Makes things `factor` times larger around the point (x, y) of the picture, which stays where it is.
/// @param x,y  from the centre to the right and up, in heights of the picture
export function zoomBy(camera, resolved, factor, x, y) {
  if (isOrbit(camera)) {
    const zoom = clamp(camera.zoom * factor, 1 / kMostZoom, kMostZoom);
    const ratio = zoom / camera.zoom;
    return orbitPatch({ zoom, pan: [x - (x - camera.pan[0]) * ratio, y - (y - camera.pan[1]) * ratio] });
  }
  const axes = viewAxes(resolved), height = heightAtTarget(camera, resolved);
  const point = add(resolved.lookAt, add(scale(axes.right, x * height), scale(axes.up, y * height)));
  const towards = (from) => add(point, scale(subtract(from, point), 1 / factor));
  if (isPerspective(camera))
    return placedPatch(camera, {...resolved, eye: towards(resolved.eye), lookAt: towards(resolved.lookAt) });
  const shift = subtract(towards(resolved.lookAt), resolved.lookAt);
  return placedPatch(camera, {
    ...resolved,
    eye: add(resolved.eye, shift),
    lookAt: add(resolved.lookAt, shift),
    viewHeight: resolved.viewHeight / factor,
  });
}

/// Turns the picture around its centre, counter-clockwise, by an angle in radians.
export function rollBy(camera, resolved, angle) {
  const axes = viewAxes(resolved);
  return placedPatch(camera, {...resolved, up: rotate(axes.up, axes.forward, angle) });
}

/// Moves the eye and its target along the view's axes: [right, up, forward], in world units. In a parallel view,
/// where to go forward changes nothing, the picture's height shrinks instead.
export function flyBy(camera, resolved, [right, up, forward]) {
  const axes = viewAxes(resolved);
  const step = add(add(scale(axes.right, right), scale(axes.up, up)), scale(axes.forward, forward));
  const moved = {...resolved, eye: add(resolved.eye, step), lookAt: add(resolved.lookAt, step) };
  if (!isPerspective(camera)) moved.viewHeight = resolved.viewHeight * Math.exp(-forward / resolved.viewHeight);
  return placedPatch(camera, moved);
}

/// Goes on turning by an angle in degrees, as a turntable does.
export function turnBy(camera, resolved, degrees) { return orbitBy(camera, resolved, -degrees / 180, 0); }

/// Looks along an axis, or back to an orbit whatever the camera was.
export function orbitTo(camera, fields) {
  const whole = { azimuth: 0, elevation: 0, zoom: 1, pan: [0, 0], ...fields };
  return orbitPatch(isOrbit(camera) ? fields : {...nulls(kPlacedFields), ...whole });
}

/// The views of the keys 1 to 6. Left and right are those of one who looks at the front.
export const kAxisViews = [
  {key: "1", name: "front", azimuth: 0, elevation: 0},
  {key: "2", name: "back", azimuth: 180, elevation: 0},
  {key: "3", name: "left", azimuth: -90, elevation: 0},
  {key: "4", name: "right", azimuth: 90, elevation: 0},
  {key: "5", name: "top", azimuth: 0, elevation: 90},
  {key: "6", name: "bottom", azimuth: 0, elevation: -90},
];

/// Returns the patch back to the camera of an earlier scene. The picture keeps its size.
export function cameraBack(camera, earlier) {
  const { size, ...patch } = replacingPatch(camera, earlier);
  return { camera: patch };
}

/// Changes between a perspective and a parallel view of about the same size.
export function toggleProjection(camera, resolved) {
  const parallel = isPerspective(camera);
  const fields = { projection: parallel ? "orthographic" : "perspective" };
  if (!isOrbit(camera)) {
    if (parallel)
      fields.viewHeight = heightAtTarget(camera, resolved);
    else {
      // The eye moves to where the field of view shows the same height at the target.
      const axes = viewAxes(resolved);
      const distance = resolved.viewHeight / (2 * Math.tan(0.5 * resolved.fov * kDegree));
      fields.eye = subtract(resolved.lookAt, scale(axes.forward, distance));
    }
  }
  return { camera: fields };
}

/// Changes the field of view by a factor, within what makes a useful picture.
export function widenBy(camera, factor) { return { camera: { fov: clamp(camera.fov * factor, 2, 150) } }; }

/// Returns the camera's vector of a direction of the world: [right, up, towards the viewer].
export function toView(axes, world) { return [dot(world, axes.right), dot(world, axes.up), -dot(world, axes.forward)]; }
/// Returns the direction of the world of a vector [right, up, towards the viewer].
export function toWorld(axes, view) {
  return add(add(scale(axes.right, view[0]), scale(axes.up, view[1])), scale(axes.forward, -view[2]));
}

/// Returns where a point of the world is in the picture: [x, y] from the centre to the right and up, in heights of the
/// picture, as pointers are; null behind the eye.
/// @param view  of Session.view()
export function project({ camera, resolved, axes }, point) {
  const offset = subtract(point, resolved.eye);
  const depth = dot(offset, axes.forward);
  if (!isPerspective(camera))
    return [dot(offset, axes.right) / resolved.viewHeight, dot(offset, axes.up) / resolved.viewHeight];
  const nearest = 1e-6 * length(subtract(resolved.lookAt, resolved.eye));
  if (depth <= nearest) return null;
  const height = 2 * depth * Math.tan(0.5 * resolved.fov * kDegree);
  return [dot(offset, axes.right) / height, dot(offset, axes.up) / height];
}

/// Returns how far a point has to go along a direction, in lengths of the direction, so that it is seen as near as
/// possible to a place of the picture.
export function travelTo(view, point, direction, [x, y]) {
  const kStep = 1e-3;
  let t = 0;
  // Newton's method: a straight line is seen as a straight line, on which places are a smooth function of t.
  for (let i = 0; i < 12; ++i) {
    const at = project(view, add(point, scale(direction, t)));
    const next = project(view, add(point, scale(direction, t + kStep)));
    if (!at || !next) break;
    const slope = [(next[0] - at[0]) / kStep, (next[1] - at[1]) / kStep];
    const square = slope[0] ** 2 + slope[1] ** 2;
    if (square < 1e-12) break;  // towards the eye: nothing is seen of the way
    const change = ((x - at[0]) * slope[0] + (y - at[1]) * slope[1]) / square;
    t += clamp(change, -1, 1);
    if (Math.abs(change) < 1e-9) break;
  }
  return t;
}
