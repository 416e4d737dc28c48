// The surfaces of the modes isosurface and hybrid: their values and opacities.
// SPDX-License-Identifier: Apache-2.0
import {numberRow} from "./controls.js";
import {button, element, section} from "./dom.js";
import {surfacePlot} from "./surface_plot.js";

/// Returns { node, update() }. The section is there in that mode alone.
export function surfacePanel(session) {
  const { low, high } = session.hello.volume;
  const values = {
    toValue: (place) => low + ((high - low) * place) / 1000,
    toPlace: (value) => (1000 * (value - low)) / (high - low),
  };
  const shares = { toValue: (place) => place / 1000, toPlace: (share) => 1000 * share };
  const surfaces = () => session.scene.surfaces ?? [];
  const changed = (index, change) =>
      ({ surfaces: surfaces().map((surface, i) => (i === index ? {...surface, ...change } : surface)) });
  const list = element("div", {});
  const plot = surfacePlot(session, surfaces, changed);
  let rows = [];

  const rowsOf = (index) => ({
    value: numberRow({
      label: `value ${index + 1}`,
      help: "of the surface",
      mapping: values,
      session,
      toPatch: (value) => changed(index, { value }),
    }),
    opacity: numberRow({
      label: `opacity ${index + 1}`,
      help: "0 to 1",
      low: 0,
      high: 1,
      mapping: shares,
      session,
      toPatch: (opacity) => changed(index, { opacity }),
    }),
  });
  const build = (count) => {
    rows = Array.from({ length: count }, (_, index) => rowsOf(index));
    list.replaceChildren(...rows.flatMap(({ value, opacity }) => [value.node, opacity.node]));
  };
  const add = button(
      "Add a surface", () => session.edit({
        surfaces: [{ value: (low + high) / 2, opacity: 0.4 }, ...surfaces()],
      }),
      "between the values of the volume");
  const remove = button("Remove the first", () => session.edit({ surfaces: surfaces().slice(1) }), "of several");
  const node = section("Isosurfaces", true, plot.node, list, element("div", { className: "buttons" }, add, remove));
  return {
    node,
    update: () => {
      node.hidden = !["isosurface", "hybrid"].includes(session.scene.mode);
      if (rows.length !== surfaces().length) build(surfaces().length);
      remove.disabled = surfaces().length < 2;
      plot.update();
      surfaces().forEach((surface, i) => {
        rows[i].value.update(surface.value);
        rows[i].opacity.update(surface.opacity ?? 1);
      });
    },
  };
}
