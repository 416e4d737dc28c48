// The plot in which a function of value and gradient magnitude is edited: shapes over a histogram of both, whose corners
// and insides are dragged.
// SPDX-License-Identifier: Apache-2.0
import {hexOfLinear} from "./colour.js";
import {cornersOf, isInside, movedShape, newShape, ShapeMemory, shapesPatch, withCorner} from "./shapes.js";
import {drawNumbers, plotArea, startPlot} from "./transfer_plot.js";

const kGrip = 11;    // pixels around a corner in which it is taken
const kStep = 0.01;  // of the plot, by an arrow key
const kInk = "#f2f4f8", kChosen = "#ffb347", kQuiet = "#aeb5c1";

// The histogram as a picture of its bins: brighter where more voxels are, by the logarithm of their count.
function histogramPicture({ values, gradients, counts }) {
  const picture = new OffscreenCanvas(values, gradients), context = picture.getContext("2d");
  const image = context.createImageData(values, gradients), most = Math.log1p(Math.max(...counts));
  counts.forEach((count, i) => {
    const row = gradients - 1 - Math.floor(i / values), at = 4 * (row * values + (i % values));
    const share = most > 0 ? Math.log1p(count) / most : 0;
    // From the plot's ground to a light grey.
    image.data.set([20 + 150 * share, 22 + 155 * share, 26 + 166 * share, 255], at);
  });
  context.putImageData(image, 0, 0);
  return picture;
}

export class ShapeEditor {
  /// @param onChosen  called when another shape is chosen or the function has changed
  constructor(canvas, session, onChosen) {
    Object.assign(this, { canvas, session_: session, onChosen_: onChosen, chosen_: 0, histogram: null });
    this.memory_ = new ShapeMemory();
    canvas.addEventListener("pointerdown", (event) => this.down_(event));
    canvas.addEventListener("pointermove", (event) => this.drag_?.move(event));
    for (const over of ["pointerup", "pointercancel"]) canvas.addEventListener(over, () => this.up_());
    canvas.addEventListener("contextmenu", (event) => this.menu_(event));
    canvas.addEventListener("keydown", (event) => this.key_(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
    session.on("gradients", (message) => this.receive_(message));
    session.on("change", () => {
      const { transfer } = session.scene;
      if (transfer === this.seen_) return;
      this.seen_ = transfer;
      if (!transfer?.gradients) return;
      if (!this.histogram) this.ask_();
      this.draw();
      this.onChosen_();
    });
  }

  /// The index of the chosen shape. Undo may have taken it away; it is the chosen one again when it comes back.
  get chosen() { return Math.max(0, Math.min(this.chosen_, (this.shapes?.length ?? 1) - 1)); }

  /// The shapes of the scene's function; null where this page has not made it.
  get shapes() {
    const transfer = this.session_.scene?.transfer;
    return transfer?.gradients ? this.memory_.find(transfer) : null;
  }
  /// Returns the patch of shapes, and remembers that it is theirs.
  patch(shapes) {
    const patch = shapesPatch(this.session_.scene.transfer, shapes, this.histogram);
    this.memory_.keep(patch.transfer, shapes);
    return patch;
  }
  /// Returns the patch that changes the chosen shape.
  changed(fields) { return this.patch(this.shapes.map((shape, i) => (i === this.chosen ? {...shape, ...fields } : shape))); }
  choose(index) {
    this.chosen_ = Math.max(0, Math.min(index, (this.shapes?.length ?? 1) - 1));
    this.draw();
    this.onChosen_();
  }
  /// Adds a shape above the others. Where there were no shapes it makes a new function.
  add(kind) {
    if (!this.histogram) {
      this.wanted_ = kind;  // its axis of gradients is on its way
      return this.ask_();
    }
    const shapes = this.shapes ?? [], sigma_t = shapes[this.chosen]?.sigma_t ?? this.usualSigma_();
    this.chosen_ = shapes.length;
    this.session_.edit(this.patch([...shapes, newShape(kind, this.histogram, sigma_t)]));
    this.onChosen_();
  }
  removeChosen() {
    const { shapes } = this;
    if (!shapes?.length) return;
    this.session_.edit(this.patch(shapes.filter((_, i) => i !== this.chosen)));
    this.choose(this.chosen - 1);
  }

  // A third of the densest of what was there: what is seen through is seen at all.
  usualSigma_() {
    const { points, sigma_t } = this.session_.scene.transfer ?? {};
    const most = Math.max(0, ...(points?.map((point) => point.sigma_t) ?? sigma_t ?? []));
    return Number((most / 3 || 0.05).toPrecision(3));
  }
  ask_() {
    if (this.asked_) return;
    this.asked_ = true;
    this.session_.askGradients();
  }
  receive_(histogram) {
    this.histogram = histogram;
    this.picture_ = histogramPicture(histogram);
    const wanted = this.wanted_;
    this.wanted_ = null;
    if (wanted) this.add(wanted);
    this.draw();
    this.onChosen_();
  }

  area_() { return plotArea(this.canvas.clientWidth, this.canvas.clientHeight); }
  place_([value, gradient]) {
    const area = this.area_(), { low, high, most } = this.histogram;
    return [area.left + ((value - low) / (high - low)) * area.width, area.top + area.height * (1 - gradient / most)];
  }
  at_(event) {
    const box = this.canvas.getBoundingClientRect(), area = this.area_(), { low, high, most } = this.histogram;
    const x = event.clientX - box.left, y = event.clientY - box.top;
    return { x, y, place: [low + ((x - area.left) / area.width) * (high - low), (1 - (y - area.top) / area.height) * most] };
  }

  draw() {
    const { transfer } = this.session_.scene ?? {};
    if (!this.histogram || !transfer?.gradients || this.canvas.clientWidth === 0) return;
    const context = startPlot(this.canvas), area = this.area_(), { low, high } = this.histogram;
    context.imageSmoothingEnabled = false;
    context.drawImage(this.picture_, area.left, area.top, area.width, area.height);
    if (this.shapes)
      this.shapes.forEach((shape, i) => this.drawShape_(context, shape, i === this.chosen));
    else
      this.drawForeign_(context, transfer);
    drawNumbers(context, area, [low, high]);
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillStyle = kQuiet;
    context.fillText("gradient \u2191   value \u2192", area.left + 5, area.top + 4);
    const corners = this.shapes?.[this.chosen] && cornersOf(this.shapes[this.chosen]);
    // Where the corners of the chosen shape are, in CSS pixels of the plot, for tests that drag them.
    this.canvas.dataset.corners = (corners ?? []).map((corner) => this.place_(corner).map(Math.round).join(",")).join(" ");
  }
  drawShape_(context, shape, chosen) {
    const corners = cornersOf(shape).map((corner) => this.place_(corner));
    const outline = new Path2D();
    corners.forEach(([x, y], i) => (i === 0 ? outline.moveTo(x, y) : outline.lineTo(x, y)));
    outline.closePath();
    context.fillStyle = hexOfLinear(shape.albedo);
    context.globalAlpha = 0.5;
    context.fill(outline);
    context.globalAlpha = 1;
    context.lineWidth = chosen ? 2 : 1;
    context.strokeStyle = chosen ? kChosen : kInk;
    context.stroke(outline);
    if (!chosen) return;
    for (const [x, y] of corners) {
      context.beginPath();
      context.arc(x, y, 5.5, 0, 2 * Math.PI);
      context.fillStyle = hexOfLinear(shape.albedo);
      context.fill();
      context.stroke();
    }
  }
  // A function that this page has not made has no shapes: its lattice lies over the histogram as it is.
  drawForeign_(context, { values, gradients, albedo, sigma_t }) {
    const most = Math.max(...sigma_t) || 1, last = (list, i) => list[Math.min(i + 1, list.length - 1)];
    gradients.forEach((gradient, j) => values.forEach((value, i) => {
      const at = j * values.length + i, [x, y] = this.place_([value, gradient]).map(Math.round);
      const [right, top] = this.place_([last(values, i), last(gradients, j)]).map(Math.round);
      context.globalAlpha = 0.7 * Math.sqrt(sigma_t[at] / most);
      context.fillStyle = hexOfLinear(albedo[at]);
      context.fillRect(x, top, right - x, y - top);
    }));
    context.globalAlpha = 1;
  }

  // Returns what is at a pointer: a corner of the chosen shape, or a shape, the upper one first.
  hit_({ x, y, place }) {
    const { shapes, chosen } = this;
    if (!shapes) return {};
    const near = shapes[chosen] ? cornersOf(shapes[chosen]).findIndex((corner) => {
      const [px, py] = this.place_(corner);
      return Math.hypot(px - x, py - y) < kGrip;
    }) : -1;
    if (near >= 0) return { shape: chosen, corner: near };
    return { shape: shapes.findLastIndex((shape) => isInside(shape, ...place)), corner: -1 };
  }

  down_(event) {
    if (event.button !== 0 || !this.shapes || !this.histogram) return;
    event.preventDefault();
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    const start = this.at_(event), { shape: index, corner } = this.hit_(start), { shapes } = this;
    if (index < 0) return;
    if (index !== this.chosen) this.choose(index);
    const first = shapes[index];
    const moved = (by) => {
      if (corner < 0) return movedShape(first, by, this.histogram);
      const [value, gradient] = cornersOf(first)[corner];
      return withCorner(first, corner, [value + by[0], gradient + by[1]], this.histogram);
    };
    let drag = null;
    this.drag_ = {
      move: (next) => {
        const { place } = this.at_(next);
        drag ??= this.session_.drag("shape");
        const shape = moved([place[0] - start.place[0], place[1] - start.place[1]]);
        drag.edit(this.patch(shapes.map((old, i) => (i === index ? shape : old))));
      },
      end: () => drag?.end(),
    };
  }
  up_() {
    const drag = this.drag_;
    this.drag_ = null;
    drag?.end();
  }
  menu_(event) {
    event.preventDefault();
    if (!this.shapes || !this.histogram) return;
    const { shape } = this.hit_(this.at_(event));
    if (shape < 0) return;
    this.chosen_ = shape;
    this.removeChosen();
  }

  key_(event) {
    if (!this.histogram || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? kStep / 10 : kStep, { low, high, most } = this.histogram;
    const move = (right, up) => this.moveChosen_([right * step * (high - low), up * step * most]);
    const actions = {
      ArrowLeft: () => move(-1, 0),
      ArrowRight: () => move(1, 0),
      ArrowUp: () => move(0, 1),
      ArrowDown: () => move(0, -1),
      PageUp: () => this.choose(this.chosen - 1),
      PageDown: () => this.choose(this.chosen + 1),
      Delete: () => this.removeChosen(),
      Backspace: () => this.removeChosen(),
      n: () => this.add("rectangle"),
      t: () => this.add("triangle"),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  }
  moveChosen_(by) {
    const shape = this.shapes?.[this.chosen];
    if (shape) this.session_.edit(this.changed(movedShape(shape, by, this.histogram)));
  }
}
