// Light sources of the model `lights`: those that are cones can be changed, all can be removed.
// SPDX-License-Identifier: Apache-2.0
import {toView, toWorld} from "./camera.js";
import {colourRow, dragOf, flagRow, numberRow, row, vectorInput} from "./controls.js";
import {button, element, newId} from "./dom.js";
import {sliderOf} from "./fields.js";
import {lightBall} from "./light_ball.js";
import {addSource, changeSource, kNewLight, newSource, removeSource, sourcesOf} from "./lights.js";

const kAngle = sliderOf({ low: 0, high: 90, kind: "number" });

// The controls of one cone. A source that stands where the removed one stood gets them anew.
function coneControls(session, index) {
  const source = () => sourcesOf(session.scene)[index];
  const toPatch = (fields) => changeSource(session.scene, index, fields);
  const rounded = (direction) => direction.map((x) => Number(x.toFixed(4)));
  const fromView = (direction) => (source().frame === "world" ? toWorld(session.view().axes, direction) : direction);
  const ball =
      lightBall(() => dragOf(session, "light", (direction) => toPatch({ axis: rounded(fromView(direction)) })));
  const axis = vectorInput({
    label: "direction towards the light",
    names: ["x", "y", "z"],
    commit: (value) => session.edit(toPatch({ axis: value }))
  });
  const id = newId();
  axis.node.querySelector("input").id = id;
  const theta = numberRow({
    label: "soft angle",
    help: "half-angle of the light, 0: hard shadows",
    unit: "degrees",
    low: 0,
    high: 90,
    mapping: kAngle,
    session,
    toPatch: (value) => toPatch({ theta: value }),
  });
  const radiance =
      colourRow({ label: "radiance", help: "linear RGB", session, toPatch: (value) => toPatch({ radiance: value }) });
  const moves = flagRow({
    label: "moves with the camera",
    help: "the direction is that of the view, not of the world",
    commit: (on) => {
      const { axes } = session.view();
      const turn = on ? toView : toWorld;
      session.edit(toPatch({ frame: on ? "view" : "world", axis: rounded(turn(axes, source().axis)) }));
    },
  });
  const node = element(
      "div", { className: "source" }, ball.node, row("direction", "towards the light", id, axis.node), theta.node,
      radiance.node, moves.node);
  return {
    node,
    update: () => {
      const { axis: direction, frame, theta: angle, radiance: light } = source();
      const view = session.view();
      ball.update(frame === "world" && view ? toView(view.axes, direction) : direction);
      axis.update(direction);
      theta.update(angle);
      radiance.update(light);
      moves.update(frame === "view");
    },
  };
}

function describe(source) {
  if (source.type === "environment") return `environment map ${source.file}`;
  return `${source.list?.length ?? 0} directions`;
}

/// Returns { node, update() }.
export function lightPanel(session) {
  const list = element("div");
  const add = () => session.edit(addSource(session.scene, newSource(toWorld(session.view().axes, kNewLight))));
  const node = element(
      "div", {}, element("h3", { textContent: "Light sources" }), list,
      element("div", { className: "buttons" }, button("Add a light", add, "and the model lights, which looks at it")));
  let kinds = "", controls = [];
  const build = (sources) => {
    controls = sources.map((source, i) => (source.type === "cone" ? coneControls(session, i) : null));
    list.replaceChildren(...sources.map(
        (source, i) => element(
            "fieldset", {}, element("legend", { textContent: `Light ${i + 1}` }),
            controls[i]?.node ?? element("p", { className: "quiet", textContent: describe(source) }),
            button("Remove light", () => session.edit(removeSource(session.scene, i))))));
  };
  return {
    node,
    update: () => {
      const sources = sourcesOf(session.scene), now = JSON.stringify(sources.map((s) => [s.type, s.file]));
      if (now !== kinds) build(sources);
      kinds = now;
      controls.forEach((control) => control?.update());
    },
  };
}
