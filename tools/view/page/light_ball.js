// A ball on which the direction of a light is dragged, seen from where the viewer is.
// SPDX-License-Identifier: Apache-2.0
import {svg} from "./dom.js";
import {directionOnBall, placeOnBall} from "./lights.js";

const kRadius = 44;  // of a drawing of 100 x 100
const kKeyStep = 0.1;

/// @param drag  begins a drag and returns { edit(direction in the view), end() }
export function lightBall(drag) {
  const mark = svg("circle", { r: 5, class: "mark" });
  const node =
      svg("svg", {
        viewBox: "-50 -50 100 100",
        class: "ball",
        tabindex: 0,
        role: "slider",
        "aria-label": "Direction of the light: drag, or arrow keys; B puts it behind the volume and back",
        "aria-valuetext": "",
      },
          svg("circle", { r: kRadius, class: "sphere" }), mark);
  let direction = [0, 0, 1], current = null;

  const place = (event) => {
    const box = node.getBoundingClientRect(), scale = 100 / box.width / kRadius;
    return [(event.clientX - box.left - box.width / 2) * scale, (box.top + box.height / 2 - event.clientY) * scale];
  };
  const move = (event) => current?.edit(directionOnBall(...place(event), placeOnBall(direction).behind));
  node.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    node.focus();
    node.setPointerCapture(event.pointerId);
    current = drag();
    move(event);
  });
  node.addEventListener("pointermove", move);
  for (const end of ["pointerup", "pointercancel"])
    node.addEventListener(end, () => {
      current?.end();
      current = null;
    });
  node.addEventListener("keydown", (event) => {
    const { x, y, behind } = placeOnBall(direction);
    const [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ??
        [0, 0];
    const turned = event.key === "b" || event.key === "B";
    if (dx === 0 && dy === 0 && !turned) return;
    event.preventDefault();
    event.stopPropagation();
    const edit = drag();
    edit.edit(directionOnBall(x + dx * kKeyStep, y + dy * kKeyStep, behind !== turned));
    edit.end();
  });
  return {
    node,
    update: (next) => {
      direction = next;
      const { x, y, behind } = placeOnBall(next);
      mark.setAttribute("cx", x * kRadius);
      mark.setAttribute("cy", -y * kRadius);
      node.classList.toggle("behind", behind);
      node.setAttribute(
          "aria-valuetext", `${x.toFixed(2)} to the right, ${y.toFixed(2)} up, ${behind ? "behind" : "in front"}`);
    },
  };
}
