// Pointers on the picture: drags orbit, pan, roll and look about, the wheel zooms, two fingers pinch; a pointer that
// only hovers asks what lies under it.
// SPDX-License-Identifier: Apache-2.0
import {lookBy, orbitBy, panBy, rollBy, zoomBy} from "./camera.js";

const kWheelRestMs = 250;  // a wheel has no end; it rests after so long
const kProbeMs = 100;

export class PictureInput {
  constructor(picture, session) {
    Object.assign(this, { picture_: picture, session_: session, pointers_: new Map(), lastProbe_: 0 });
    const { canvas } = picture;
    canvas.addEventListener("pointerdown", (event) => this.down_(event));
    canvas.addEventListener("pointermove", (event) => this.move_(event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => this.up_(event));
    canvas.addEventListener("wheel", (event) => this.wheel_(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerleave", () => session.emit("probeLeft"));
  }

  down_(event) {
    if (!this.session_.scene) return;
    event.preventDefault();
    this.picture_.canvas.focus();
    this.picture_.canvas.setPointerCapture(event.pointerId);
    this.pointers_.set(event.pointerId, this.picture_.place(event));
    this.session_.emit("cameraTouched");
    this.drag_ ??= this.session_.drag("camera");
    this.kind_ = event.button === 2          ? "roll" :
        event.button === 1 || event.shiftKey ? "pan" :
        event.altKey                         ? "look" :
                                               "orbit";
  }

  up_(event) {
    this.pointers_.delete(event.pointerId);
    if (this.pointers_.size > 0 || !this.drag_) return;
    this.drag_.end();
    this.drag_ = null;
  }

  move_(event) {
    const place = this.picture_.place(event);
    const before = this.pointers_.get(event.pointerId);
    if (!before) {
      this.probe_(place);
      return;
    }
    const middleBefore = this.middle_();
    this.pointers_.set(event.pointerId, place);
    if (this.pointers_.size === 1)
      this.dragTo_(before, place);
    else
      this.pinch_(middleBefore, this.middle_());
  }

  // The camera's move from one place of the pointer to the next.
  dragTo_(before, place) {
    const { camera, resolved } = this.session_.view();
    const dx = place.x - before.x, dy = before.y - place.y;
    if (dx === 0 && dy === 0) return;
    switch (this.kind_) {
      case "pan":
        return this.drag_.edit(panBy(camera, resolved, dx, dy));
      case "look":
        return this.drag_.edit(lookBy(camera, resolved, dx, dy));
      case "roll": {
        const angle = Math.atan2(place.y, place.x) - Math.atan2(before.y, before.x);
        return this.drag_.edit(rollBy(camera, resolved, angle));
      }
      default:
        return this.drag_.edit(orbitBy(camera, resolved, dx, dy));
    }
  }

  // The centre of the first two fingers and how far they are apart.
  middle_() {
    const [a, b] = [...this.pointers_.values()];
    if (!b) return null;
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.max(1e-3, Math.hypot(a.x - b.x, a.y - b.y)) };
  }

  pinch_(before, now) {
    let view = this.session_.view();
    this.drag_.edit(zoomBy(view.camera, view.resolved, now.apart / before.apart, before.x, before.y));
    view = this.session_.view();
    this.drag_.edit(panBy(view.camera, view.resolved, now.x - before.x, before.y - now.y));
  }

  wheel_(event) {
    const view = this.session_.view();
    if (!view) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? event.deltaY * 16 : event.deltaY;
    const { x, y } = this.picture_.place(event);
    this.session_.emit("cameraTouched");
    this.wheelDrag_ ??= this.session_.drag("zoom");
    const factor = Math.exp(-Math.max(-240, Math.min(240, lines)) * 0.0015);
    this.wheelDrag_.edit(zoomBy(view.camera, view.resolved, factor, x, y));
    clearTimeout(this.wheelTimer_);
    this.wheelTimer_ = setTimeout(() => {
      this.wheelDrag_.end();
      this.wheelDrag_ = null;
    }, kWheelRestMs);
  }

  // Asks at most ten times a second; the last place is asked for when the pointer rests.
  probe_(place) {
    clearTimeout(this.probeTimer_);
    if (!place.inside || !this.session_.scene) return;
    const wait = this.lastProbe_ + kProbeMs - performance.now();
    this.probeTimer_ = setTimeout(() => {
      this.lastProbe_ = performance.now();
      this.session_.probe(...place.pixel);
    }, Math.max(0, wait));
  }
}
