// The values of isosurfaces as lines over the histogram, which are dragged.
// SPDX-License-Identifier: Apache-2.0
import {element} from "./dom.js";
import {drawBars, drawNumbers, plotArea, startPlot} from "./transfer_plot.js";

const kGrip = 9;  // pixels
const kLine = "#f2f4f8", kChosen = "#ffb347";

/// Returns the index of the surface whose line is nearest to a value, or -1 where none is within `reach`. Of equally
/// near ones the last is taken, which is drawn above the others.
export function nearestSurface(surfaces, value, reach) {
  let best = -1, nearest = reach;
  surfaces.forEach((surface, i) => {
    const distance = Math.abs(surface.value - value);
    if (distance <= nearest) [best, nearest] = [i, distance];
  });
  return best;
}

/// Returns { node, update() }. @param changed  returns the patch that changes one surface
export function surfacePlot(session, surfaces, changed) {
  const node = element("canvas", {
    className: "transfer surfaces",
    id: "surfaces",
    role: "img",
    "aria-label": "Values of the surfaces over the histogram of the volume; the sliders below set them, too",
  });
  const { low, high } = session.hello.volume;
  const margin = 0.02 * (high - low), range = [low - margin, high + margin];
  const area = () => plotArea(node.clientWidth, node.clientHeight);
  const placeOf = (value) => area().left + ((value - range[0]) / (range[1] - range[0])) * area().width;
  const valueAt = (event) => {
    const x = event.clientX - node.getBoundingClientRect().left;
    return range[0] + ((x - area().left) / area().width) * (range[1] - range[0]);
  };
  const reach = () => (kGrip / area().width) * (range[1] - range[0]);
  let drag = null, held = -1;
  const draw = () => {
    if (!node.clientWidth) return;
    const context = startPlot(node), { top, height } = area();
    drawBars(context, area(), session.hello.volume, range);
    drawNumbers(context, area(), range);
    surfaces().forEach((surface, i) => {
      const x = placeOf(surface.value);
      context.fillStyle = i === held ? kChosen : kLine;
      context.globalAlpha = 0.4 + 0.6 * (surface.opacity ?? 1);
      context.fillRect(x - 1, top, 2, height);
      context.beginPath();
      context.arc(x, top + 5, 5, 0, 2 * Math.PI);
      context.fill();
      context.globalAlpha = 1;
    });
    // Where the lines are, in CSS pixels of the plot, for tests that drag them.
    node.dataset.lines = surfaces().map(({ value }) => Math.round(placeOf(value))).join(" ");
  };
  node.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    held = nearestSurface(surfaces(), valueAt(event), reach());
    if (held < 0) return;
    event.preventDefault();
    node.setPointerCapture(event.pointerId);
    drag = { edits: session.drag("surface"), off: surfaces()[held].value - valueAt(event) };
    draw();
  });
  node.addEventListener("pointermove", (event) => {
    node.style.cursor = drag || nearestSurface(surfaces(), valueAt(event), reach()) >= 0 ? "ew-resize" : "";
    if (!drag) return;
    const value = Math.min(high, Math.max(low, valueAt(event) + drag.off));
    drag.edits.edit(changed(held, { value: Number(value.toPrecision(6)) }));
  });
  for (const over of ["pointerup", "pointercancel"])
    node.addEventListener(over, () => {
      drag?.edits.end();
      drag = null;
      held = -1;
      draw();
    });
  node.addEventListener("dblclick", (event) => {
    if (nearestSurface(surfaces(), valueAt(event), reach()) >= 0) return;
    const value = Number(Math.min(high, Math.max(low, valueAt(event))).toPrecision(6));
    session.edit({ surfaces: [{ value, opacity: 0.4 }, ...surfaces()] });
  });
  node.addEventListener("contextmenu", (event) => {
    event.preventDefault();
    const at = nearestSurface(surfaces(), valueAt(event), reach());
    if (at >= 0 && surfaces().length > 1) session.edit({ surfaces: surfaces().filter((_, i) => i !== at) });
  });
  new ResizeObserver(draw).observe(node);
  return { node, update: draw };
}
