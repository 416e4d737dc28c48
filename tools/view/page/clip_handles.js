// The clip box over the picture: its edges, and a handle in the middle of each face that is dragged along its axis.
// SPDX-License-Identifier: Apache-2.0
import {project, travelTo} from "./camera.js";
import {boxOf, boxPatch, withFace} from "./clip.js";
import {svg} from "./dom.js";
import {dot, scale, subtract} from "./vector.js";

const kNames = ["x", "y", "z"];

/// Returns the corners of a box by their bits: bit a says whether the corner is at the high end of axis a.
const cornerOf = (box, bits) => [0, 1, 2].map((axis) => box[(bits >> axis) & 1][axis]);

/// Returns the twelve edges: pairs of corners that differ in one axis.
export function edgesOf(box) {
  const edges = [];
  for (let bits = 0; bits < 8; ++bits)
    for (let axis = 0; axis < 3; ++axis)
      if (!((bits >> axis) & 1)) edges.push([cornerOf(box, bits), cornerOf(box, bits | (1 << axis))]);
  return edges;
}

/// Returns the faces: [{ axis, end, centre, away }]; `away` where the face looks away from the eye.
export function facesOf(box, { resolved, axes, camera }) {
  const middle = box[0].map((low, i) => (low + box[1][i]) / 2);
  const faces = [];
  for (let axis = 0; axis < 3; ++axis)
    for (let end = 0; end < 2; ++end) {
      const centre = middle.map((m, i) => (i === axis ? box[end][axis] : m));
      const normal = [0, 1, 2].map((i) => (i === axis ? 2 * end - 1 : 0));
      const towards = camera.projection === "orthographic" ? scale(axes.forward, -1) : subtract(resolved.eye, centre);
      faces.push({ axis, end, centre, away: dot(normal, towards) <= 0 });
    }
  return faces;
}

/// Returns the value of a face whose handle is dragged to a place of the picture, within the volume.
export function draggedFace(view, face, place, bounds) {
  const direction = [0, 1, 2].map((i) => (i === face.axis ? bounds[1][i] - bounds[0][i] : 0));
  const t = travelTo(view, face.centre, direction, place);
  const value = face.centre[face.axis] + t * direction[face.axis];
  return Number(Math.min(bounds[1][face.axis], Math.max(bounds[0][face.axis], value)).toPrecision(6));
}

export class ClipHandles {
  /// @param node     an SVG element over the picture
  /// @param picture  of class Picture
  constructor(node, picture, session) {
    Object.assign(this, { node_: node, picture_: picture, session_: session, drag_: null });
    this.edges_ = svg("g", { class: "edges" });
    this.handles_ = [0, 1, 2].flatMap((axis) => [0, 1].map((end) => this.handle_(axis, end)));
    node.append(this.edges_, ...this.handles_.map((each) => each.node));
  }

  handle_(axis, end) {
    const node = svg(
        "circle", { class: `handle axis-${kNames[axis]}`, r: 8, role: "img", "data-face": `${kNames[axis]}${end}` },
        svg("title"));
    node.firstChild.textContent = `clip box, ${kNames[axis]} ${end === 0 ? "from" : "to"}`;
    node.addEventListener("pointerdown", (event) => this.down_(event, axis, end));
    node.addEventListener("pointermove", (event) => this.move_(event));
    for (const over of ["pointerup", "pointercancel"]) node.addEventListener(over, () => this.up_());
    return { node, axis, end };
  }

  /// Draws the box where the camera sees it now.
  update() {
    const { node_: node, session_: session } = this;
    const box = boxOf(session.scene), view = session.view();
    node.toggleAttribute("hidden", !box);
    if (!box) return;
    const { canvas } = this.picture_;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    node.setAttribute("viewBox", `0 0 ${width} ${height}`);
    Object.assign(node.style, {
      left: `${canvas.offsetLeft}px`,
      top: `${canvas.offsetTop}px`,
      width: `${width}px`,
      height: `${height}px`
    });
    const pixel = (point) => {
      const place = project(view, point);
      return place && [width / 2 + place[0] * height, height / 2 - place[1] * height];
    };
    this.edges_.replaceChildren(...edgesOf(box).flatMap(([a, b]) => {
      const [p, q] = [pixel(a), pixel(b)];
      return p && q ? [svg("line", { x1: p[0], y1: p[1], x2: q[0], y2: q[1] })] : [];
    }));
    const faces = facesOf(box, view);
    this.handles_.forEach(({ node: handle, axis, end }) => {
      const face = faces.find((each) => each.axis === axis && each.end === end);
      const at = pixel(face.centre);
      handle.toggleAttribute("hidden", !at);
      if (!at) return;
      handle.setAttribute("cx", at[0]);
      handle.setAttribute("cy", at[1]);
      handle.classList.toggle("away", face.away);
    });
  }

  down_(event, axis, end) {
    if (event.button !== 0) return;
    event.preventDefault();
    event.stopPropagation();
    event.target.setPointerCapture(event.pointerId);
    const box = boxOf(this.session_.scene), view = this.session_.view();
    const face = facesOf(box, view).find((each) => each.axis === axis && each.end === end);
    const { x, y } = this.picture_.place(event), seen = project(view, face.centre);
    // The handle keeps its distance to the pointer, so that a click without a move changes nothing.
    const held = [seen[0] - x, seen[1] - y];
    this.drag_ = { face, box, held, edits: this.session_.drag("clip") };
  }
  move_(event) {
    if (!this.drag_) return;
    const { face, box, held, edits } = this.drag_;
    const { x, y } = this.picture_.place(event);
    const value = draggedFace(
        this.session_.view(), face, [x + held[0], y + held[1]], this.session_.hello.volume.bounds);
    edits.edit(boxPatch(withFace(box, face.axis, face.end, value)));
  }
  up_() {
    this.drag_?.edits.end();
    this.drag_ = null;
  }
}
