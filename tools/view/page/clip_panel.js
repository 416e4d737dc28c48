// Clip box and clip planes.
// SPDX-License-Identifier: Apache-2.0
import {axisPlane, boxOf, boxPatch, facingPlane, flipped, planeOffsets, planesOf, planesPatch, withFace} from "./clip.js";
import {dragOf, flagRow, numberRow, row, sliderInput, vectorInput} from "./controls.js";
import {button, element, newId, section} from "./dom.js";

const between = (low, high) => ({
  toValue: (place) => Number((low + ((high - low) * place) / 1000).toPrecision(6)),
  toPlace: (value) => (high > low ? (1000 * (value - low)) / (high - low) : 0),
});

function boxControls(session) {
  const { bounds } = session.hello.volume;
  // The box that was on last, so that off and on again does not lose it.
  let last = bounds;
  const on = flagRow({
    label: "clip box",
    help: "shows only what is inside",
    commit: (value) => session.edit(boxPatch(value ? last : null))
  });
  const faces = ["x", "y", "z"].flatMap(
      (name, axis) => ["from", "to"].map(
          (word, end) => ({
            axis,
            end,
            ...numberRow({
              label: `${name} ${word}`,
              help: "world units",
              mapping: between(bounds[0][axis], bounds[1][axis]),
              session,
              toPatch: (value) => boxPatch(withFace(boxOf(session.scene) ?? last, axis, end, value)),
            }),
          })));
  return {
    node: element("div", {}, on.node, ...faces.map((face) => face.node)),
    update: () => {
      const box = boxOf(session.scene);
      on.update(box !== null);
      last = box ?? last;
      for (const { node, update, axis, end } of faces) {
        node.hidden = box === null;
        update(last[end][axis]);
      }
    },
  };
}

function planeControls(session, index) {
  const planes = () => planesOf(session.scene);
  const toPatch = (plane) => planesPatch(planes().map((old, i) => (i === index ? plane : old)));
  const numbers = vectorInput(
      { label: `plane ${index + 1}`, names: ["a", "b", "c", "d"], commit: (plane) => session.edit(toPatch(plane)) });
  const id = newId();
  numbers.node.querySelector("input").id = id;
  const range = () => planeOffsets(planes()[index], session.hello.volume.bounds);
  const slider = sliderInput({
    label: `plane ${index + 1}, place`,
    mapping: {
      toValue: (place) => between(...range()).toValue(place),
      toPlace: (value) => between(...range()).toPlace(value)
    },
    drag: () => dragOf(session, "plane", (d) => toPatch([...planes()[index].slice(0, 3), d])),
  });
  const sliderId = newId();
  slider.node.id = sliderId;
  const buttons = element(
      "div", { className: "buttons" }, button("Other side", () => session.edit(toPatch(flipped(planes()[index])))),
      button("Remove plane", () => session.edit(planesPatch(planes().filter((_, i) => i !== index)))));
  const help = "keeps a x + b y + c z + d >= 0, world";
  return {
    node: element(
        "fieldset", {}, element("legend", { textContent: `Plane ${index + 1}` }),
        row("a b c d", help, id, numbers.node), row("place", "moves the plane along its normal", sliderId, slider.node),
        buttons),
    update: () => {
      numbers.update(planes()[index]);
      slider.update(planes()[index][3]);
    },
  };
}

/// Returns { node, update() }.
export function clipPanel(session) {
  const box = boxControls(session), list = element("div");
  const { bounds } = session.hello.volume;
  const centre = bounds[0].map((low, i) => (low + bounds[1][i]) / 2);
  const add = (plane) => session.edit(planesPatch([...planesOf(session.scene), plane]));
  const buttons = element(
      "div", { className: "buttons" },
      button(
          "Plane facing me", () => add(facingPlane(session.view().axes.forward, centre)),
          "through the middle; cuts away what is nearer"),
      ...["x", "y", "z"].map(
          (name, axis) => button(
              `Plane ${name}`, () => add(axisPlane(axis, centre)), `at right angles to ${name}, through the middle`)));
  let controls = [];
  return {
    node: section("Clipping", false, box.node, element("h3", { textContent: "Planes" }), list, buttons),
    update: () => {
      box.update();
      const count = planesOf(session.scene).length;
      if (count !== controls.length) {
        controls = Array.from({ length: count }, (_, i) => planeControls(session, i));
        list.replaceChildren(...controls.map((control) => control.node));
      }
      controls.forEach((control) => control.update());
    },
  };
}
