// The plot in which a transfer function is edited by pointer and keys. Values are the grid's; a function in another
// unit is moved to them and back.
// SPDX-License-Identifier: Apache-2.0
import {movedRange, shareOfSigma, sigmaOfShare, sigmaTop, wholeRange, zoomedRange} from "./plot_axes.js";
import {pointsOf, pointsPatch, shifted, unitOffset, withAdded, withoutPoint, withPoint} from "./transfer.js";
import {drawTransferPlot, isOver, plotArea} from "./transfer_plot.js";

const kGrip = 14;    // pixels around a point in which it is taken
const kStep = 0.01;  // of the axis, by an arrow key
const kFineStep = 0.001;

export class TransferEditor {
  /// @param onChosen  called when another point is chosen or the function has changed
  constructor(canvas, session, onChosen) {
    Object.assign(
        this, { canvas, session_: session, onChosen_: onChosen, chosen: 0, logarithmic: false, range_: null });
    canvas.addEventListener("pointerdown", (event) => this.down_(event));
    canvas.addEventListener("pointermove", (event) => this.drag_?.move(event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => this.up_());
    canvas.addEventListener("dblclick", (event) => this.add_(event));
    canvas.addEventListener("contextmenu", (event) => this.menu_(event));
    canvas.addEventListener("wheel", (event) => this.wheel_(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.key_(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
    session.on("change", () => {
      if (session.scene.transfer !== this.seen_) this.changed_();
    });
  }

  /// The function's points in values of the grid, or null.
  get points() {
    const points = pointsOf(this.session_.scene?.transfer);
    return points && shifted(points, this.offset_());
  }
  /// Returns the patch of points in values of the grid.
  patch(points) { return pointsPatch(this.session_.scene.transfer, shifted(points, -this.offset_())); }
  setLogarithmic(on) {
    this.logarithmic = on;
    this.draw();
  }
  showAll() {
    this.range_ = null;
    this.draw();
  }
  choose(index) {
    this.chosen = Math.max(0, Math.min(index, (this.points?.length ?? 1) - 1));
    this.draw();
    this.onChosen_();
  }
  /// Adds a point in the middle between the chosen one and the next, on the curve.
  addBeside() {
    const points = this.points, a = points[this.chosen], b = points[this.chosen + 1] ?? {...a, value: this.range()[1] };
    this.insert_((a.value + b.value) / 2, (a.sigma_t + b.sigma_t) / 2);
  }
  removeChosen() {
    const points = this.points;
    this.session_.edit(this.patch(withoutPoint(points, this.chosen)));
    this.choose(Math.min(this.chosen, points.length - 2));
  }

  offset_() { return unitOffset(this.session_.scene.transfer.unit ?? "", this.session_.hello.volume.unit ?? ""); }
  whole_() {
    const { low, high } = this.session_.hello.volume;
    return wholeRange(low, high, this.points);
  }
  range() { return this.range_ ?? this.drag_?.whole ?? this.whole_(); }

  changed_() {
    this.seen_ = this.session_.scene.transfer;
    const count = this.points?.length ?? 0;
    if (this.chosen >= count) this.chosen = Math.max(0, count - 1);
    // While a point is dragged the axis stays, or the point would run away from the pointer.
    if (!this.drag_ && this.points) this.top_ = sigmaTop(this.points);
    this.draw();
    this.onChosen_();
  }

  area_() { return plotArea(this.canvas.clientWidth, this.canvas.clientHeight); }
  places_(points) {
    const area = this.area_(), [low, high] = this.range();
    return points.map(
        (point) =>
            [area.left + ((point.value - low) / (high - low)) * area.width,
             area.top + area.height * (1 - shareOfSigma(point.sigma_t, this.top_, this.logarithmic)),
    ]);
  }
  // Returns value and sigma_t at a pointer.
  at_(event) {
    const box = this.canvas.getBoundingClientRect(), area = this.area_(), [low, high] = this.range();
    const x = event.clientX - box.left, y = event.clientY - box.top;
    return {
      x,
      y,
      value: low + ((x - area.left) / area.width) * (high - low),
      sigma_t: sigmaOfShare(1 - (y - area.top) / area.height, this.top_, this.logarithmic),
    };
  }
  // Returns the index of the point at a pointer, or -1. Of points that lie on each other the chosen one is taken.
  pointAt_(event) {
    if (!this.points) return -1;
    const { x, y } = this.at_(event);
    let best = -1, nearest = kGrip;
    this.places_(this.points).forEach(([px, py], i) => {
      if (!isOver(this.area_(), [px, py])) return;
      const distance = Math.hypot(px - x, py - y) - (i === this.chosen ? 0.5 : 0);
      if (distance < nearest) [best, nearest] = [i, distance];
    });
    return best;
  }

  draw() {
    const { hello, scene } = this.session_;
    if (!hello || !scene || this.canvas.clientWidth === 0) return;
    if (scene.transfer?.gradients) return;  // of a function of gradients there is another plot
    const points = this.points;
    this.top_ ??= points ? sigmaTop(points) : 1;
    const places = points && this.places_(points);
    const plot = {
      points,
      places,
      chosen: this.chosen,
      range: this.range(),
      top: this.top_,
      logarithmic: this.logarithmic
    };
    drawTransferPlot(this.canvas, {...plot, volume: hello.volume });
    // Where the chosen point is, in CSS pixels of the plot, for tests that drag it.
    if (places) this.canvas.dataset.chosen = places[this.chosen].map(Math.round).join(" ");
  }

  down_(event) {
    if (event.button !== 0 || !this.points) return;
    event.preventDefault();
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    const index = this.pointAt_(event), start = this.at_(event), points = this.points, whole = this.whole_();
    if (event.shiftKey)
      this.drag_ = this.windowDrag_(points, start);
    else if (index >= 0)
      this.drag_ = this.pointDrag_(points, index, start);
    else
      this.drag_ = this.rangeDrag_(start);
    this.drag_.whole = whole;
    if (index >= 0) this.choose(index);
  }
  up_() {
    const drag = this.drag_;
    this.drag_ = null;
    drag?.end?.();
    if (drag) this.changed_();
  }

  pointDrag_(points, index, start) {
    // The point keeps its distance to the pointer, so that a click without a move changes nothing.
    const [px, py] = this.places_(points)[index];
    const moved = { clientX: px - start.x, clientY: py - start.y };
    return this.editing_("point", (event) => {
      const { value, sigma_t } =
          this.at_({ clientX: event.clientX + moved.clientX, clientY: event.clientY + moved.clientY });
      return withPoint(points, index, { value, sigma_t });
    });
  }
  windowDrag_(points, start) {
    return this.editing_("window", (event) => shifted(points, this.at_(event).value - start.value));
  }
  editing_(name, pointsAt) {
    let drag = null;
    return {
      move: (event) => {
        drag ??= this.session_.drag(name);
        drag.edit(this.patch(pointsAt(event)));
      },
      end: () => drag?.end(),
    };
  }
  // Beside the points a drag moves along the axis; nothing of the scene changes.
  rangeDrag_(start) {
    return {
      move: (event) => {
        this.range_ = movedRange(this.range(), start.value - this.at_(event).value, this.whole_());
        this.draw();
      },
    };
  }

  add_(event) {
    if (!this.points || this.pointAt_(event) >= 0) return;
    const { value, sigma_t } = this.at_(event);
    this.insert_(value, sigma_t);
  }
  insert_(value, sigma_t) {
    const { points, index } = withAdded(this.points, value, sigma_t);
    this.session_.edit(this.patch(points));
    this.choose(index);
  }
  menu_(event) {
    event.preventDefault();
    const index = this.pointAt_(event);
    if (index < 0) return;
    this.chosen = index;
    this.removeChosen();
  }
  wheel_(event) {
    if (!this.session_.hello) return;
    event.preventDefault();
    const factor = Math.exp(-Math.max(-240, Math.min(240, event.deltaY)) * 0.003);
    this.range_ = zoomedRange(this.range(), factor, this.at_(event).value, this.whole_());
    this.draw();
  }

  key_(event) {
    if (!this.points || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? kFineStep : kStep, [low, high] = this.range();
    const move = (right, up) => this.moveChosen_(right * step * (high - low), up * step);
    const actions = {
      ArrowLeft: () => move(-1, 0),
      ArrowRight: () => move(1, 0),
      ArrowUp: () => move(0, 1),
      ArrowDown: () => move(0, -1),
      PageUp: () => this.choose(this.chosen - 1),
      PageDown: () => this.choose(this.chosen + 1),
      Home: () => this.choose(0),
      End: () => this.choose(Infinity),
      Delete: () => this.removeChosen(),
      Backspace: () => this.removeChosen(),
      n: () => this.addBeside(),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  }
  moveChosen_(byValue, byShare) {
    const points = this.points, { value, sigma_t } = points[this.chosen];
    const share = shareOfSigma(sigma_t, this.top_, this.logarithmic) + byShare;
    const next = byShare === 0 ? sigma_t : sigmaOfShare(share, this.top_, this.logarithmic);
    this.session_.edit(this.patch(withPoint(points, this.chosen, { value: value + byValue, sigma_t: next })));
  }
}
