// Keys of the page, in one table that also makes the list of keys.
// SPDX-License-Identifier: Apache-2.0
import {cameraBack, flyBy, kAxisViews, orbitBy, orbitTo, toggleProjection, turnBy, widenBy} from "./camera.js";
import {length, subtract} from "./vector.js";

const kTurnPerSecond = 30;   // degrees, of the turntable
const kFlyPerSecond = 0.25;  // diagonals of the volume
const kFastFlight = 4;
const kTapSeconds = 0.05;  // of flight, for a key that is only tapped
const kWiden = 1.1;

const kFlight = {
  w: [0, 0, 1],
  s: [0, 0, -1],
  a: [-1, 0, 0],
  d: [1, 0, 0],
  e: [0, 1, 0],
  q: [0, -1, 0],
};

/// What the list of keys says.
export const kKeyList = [
  [
    "Picture",
    [
      ["drag", "turn around the volume"],
      ["Shift + drag, middle drag", "move the picture"],
      ["wheel", "zoom to the pointer"],
      ["right drag", "roll around the centre"],
      ["Alt + drag", "look about from where the eye is"],
      ["one finger; two fingers", "turn; pinch and move"],
      ["W A S D, Q E", "fly forward, left, back, right, down and up; with Shift faster"],
      ["arrow keys", "turn by 5 degrees; with Shift by 1"],
      [kAxisViews.map((view) => view.key).join(" "), kAxisViews.map((view) => view.name).join(", ")],
      ["R", "back to the first view"],
      ["O", "parallel or perspective view"],
      ["+  -", "field of view"],
      ["T", "turntable, until T or a drag"],
    ]
  ],
  [
    "Sequence",
    [
      ["P", "play, stop"],
      [",  .", "frame before, after"],
      ["L", "loop"],
    ]
  ],
  [
    "Everywhere",
    [
      ["Ctrl Z, Ctrl Y", "undo, redo"],
      ["Space", "pause, go on"],
      ["?", "this list"],
    ]
  ],
  [
    "Transfer function",
    [
      ["drag a point", "value and sigma_t"],
      ["double click, N", "add a point"],
      ["right click, Delete", "remove a point"],
      ["Shift + drag", "move the whole function along the values"],
      ["wheel; drag beside points", "zoom on the values; move along them"],
      ["arrow keys; with Shift", "move the chosen point; finely"],
      ["Page up, Page down", "choose the point before, after"],
    ]
  ],
  [
    "Function of value and gradient",
    [
      ["drag a corner, a shape", "changes it, moves it"],
      ["N, T", "add a rectangle, a triangle"],
      ["right click, Delete", "remove a shape"],
      ["arrow keys; with Shift", "move the chosen shape; finely"],
      ["Page up, Page down", "choose the shape before, after"],
    ]
  ],
  [
    "Clip box, isosurfaces",
    [
      ["drag a handle in the picture", "moves a face of the clip box"],
      ["drag a line of the histogram", "changes the value of a surface"],
      ["double click, right click there", "add, remove a surface"],
    ]
  ],
];

const isText = (target) =>
    target.closest?.("input:not([type=range]):not([type=checkbox]), textarea, select, dialog") !== null;

export class Keys {
  /// @param actions  undo(), redo(), pause(), help(), and play(), loop(), before(), after() of a sequence
  constructor(session, actions) {
    Object.assign(this, { session_: session, actions_: actions, held_: new Set(), turning: false });
    addEventListener("keydown", (event) => this.down_(event));
    addEventListener("keyup", (event) => this.held_.delete(event.key.toLowerCase()));
    addEventListener("blur", () => this.held_.clear());
    session.on("cameraTouched", () => this.turn(false));
  }

  down_(event) {
    if (isText(event.target) || !this.session_.scene) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.metaKey) {
      const action = key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : null;
      if (!action) return;
      event.preventDefault();
      this.actions_[action]();
      return;
    }
    if (event.altKey || !this.plain_(key, event)) return;
    event.preventDefault();
  }

  // Returns whether the key means something.
  plain_(key, event) {
    // Space and arrow keys belong to the control that has the focus, where there is one.
    const onControl = event.target.closest?.("button, summary, input, a") !== null;
    if (kFlight[key]) return this.fly_(key, event.shiftKey);
    const view = this.session_.view();
    const found = kAxisViews.find((axisView) => axisView.key === key);
    if (found)
      return this.move_(orbitTo(view.camera, { azimuth: found.azimuth, elevation: found.elevation, pan: [0, 0] }));
    if (key.startsWith("Arrow") && !onControl) return this.arrow_(key, event.shiftKey, view);
    switch (key) {
      case " ":
        if (onControl) return false;
        this.actions_.pause();
        return true;
      case "?":
        this.actions_.help();
        return true;
      case "r":
        return this.move_(cameraBack(view.camera, this.session_.firstScene.camera));
      case "o":
        return this.move_(toggleProjection(view.camera, view.resolved));
      case "+":
      case "=":
        return this.move_(widenBy(view.camera, kWiden));
      case "-":
        return this.move_(widenBy(view.camera, 1 / kWiden));
      case "t":
        this.turn(!this.turning);
        return true;
      case "p":
        this.actions_.play();
        return true;
      case "l":
        this.actions_.loop();
        return true;
      case ",":
        this.actions_.before();
        return true;
      case ".":
        this.actions_.after();
        return true;
      default:
        return false;
    }
  }

  move_(patch) {
    this.session_.emit("cameraTouched");
    this.session_.edit(patch);
    return true;
  }

  arrow_(key, fine, { camera, resolved }) {
    const degrees = fine ? 1 : 5;
    const [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
    return this.move_(orbitBy(camera, resolved, (dx * degrees) / 180, (dy * degrees) / 180));
  }

  fly_(key, fast) {
    this.fast_ = fast;
    this.held_.add(key);
    if (this.flight_) return true;
    this.session_.emit("cameraTouched");
    this.flight_ = this.session_.drag("fly");
    this.flyFor_(kTapSeconds);
    this.animate_((seconds) => {
      if (this.held_.size > 0) return this.flyFor_(seconds);
      this.flight_.end();
      this.flight_ = null;
      return false;
    });
    return true;
  }

  // Flies the way that the held keys make together.
  flyFor_(seconds) {
    const { bounds } = this.session_.hello.volume;
    const far = seconds * kFlyPerSecond * length(subtract(bounds[1], bounds[0])) * (this.fast_ ? kFastFlight : 1);
    const move = [0, 1, 2].map((i) => [...this.held_].reduce((sum, held) => sum + kFlight[held][i] * far, 0));
    const { camera, resolved } = this.session_.view();
    this.flight_.edit(flyBy(camera, resolved, move));
    return true;
  }

  /// Starts or stops the turntable.
  turn(on) {
    if (on === this.turning) return;
    this.turning = on;
    this.session_.emit("turntable", on);
    if (!on) return;
    const drag = this.session_.drag("turntable");
    this.animate_((seconds) => {
      if (!this.turning) {
        drag.end();
        return false;
      }
      const { camera, resolved } = this.session_.view();
      drag.edit(turnBy(camera, resolved, kTurnPerSecond * seconds));
      return true;
    });
  }

  // Calls `step` with the seconds since its last call, at each animation frame, until it returns false.
  animate_(step) {
    let last = performance.now();
    const next = (now) => {
      const seconds = Math.min(0.1, (now - last) / 1000);
      last = now;
      if (step(seconds)) requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }
}
