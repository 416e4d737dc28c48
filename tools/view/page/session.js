// What the page knows of the server: its greeting and the scene, which is the state of everything shown. Edits are
// applied here at once and sent on, so that controls follow the hand; the server's scene is taken over at rest.
// SPDX-License-Identifier: Apache-2.0
import {isOrbit, orbitFrame, resolveCamera, viewAxes} from "./camera.js";
import {applyPatch} from "./merge_patch.js";

export class Session {
  /// @param send   sends a message that is no edit
  /// @param pacer  an EditPacer, which sends edits
  constructor(send, pacer) {
    Object.assign(this, { send_: send, pacer_: pacer, listeners_: {}, steps_: 0 });
    // Steps of two pages of one scene must not be taken for one.
    this.page_ = Math.random().toString(36).slice(2, 8);
    this.hello = null;
    this.scene = null;       // with all edits of this page
    this.firstScene = null;  // as it was when the page was opened
    this.served = null;      // the server's last message of it
    this.sequence = null;    // which frame of a sequence is shown, and whether it plays: the server's last message
    this.moving_ = false;
    this.doubtful_ = false;
  }

  on(event, listener) { (this.listeners_[event] ??= []).push(listener); }
  emit(event, value) {
    for (const listener of this.listeners_[event] ?? []) listener(value);
  }

  /// Calls `build` and returns what it returns, and a function that takes away all listeners that it has added.
  collect(build) {
    const before = Object.fromEntries(Object.entries(this.listeners_).map(([event, list]) => [event, new Set(list)]));
    const built = build();
    const added = Object.entries(this.listeners_)
                      .map(([event, list]) => [event, new Set(list.filter((each) => !before[event]?.has(each)))]);
    const remove = () => {
      for (const [event, listeners] of added)
        this.listeners_[event] = this.listeners_[event].filter((each) => !listeners.has(each));
    };
    return [built, remove];
  }

  /// Forgets the scene: the server shows another volume.
  forget() {
    this.pacer_.reset();
    Object.assign(this, { scene: null, firstScene: null, served: null, sequence: null, orbitFrame_: null });
    Object.assign(this, { moving_: false, doubtful_: false });
  }

  /// Takes a message of the server.
  receive(message) {
    if (message.type === "hello") this.hello = message;
    if (message.type === "scene") this.receiveScene_(message);
    if (message.type === "sequence") this.sequence = message;
    if (message.type === "error") {
      // The edit was refused: what the page shows is not what the server has.
      this.doubtful_ = true;
      if (!this.moving_) this.takeServed_();
    }
    this.emit(message.type, message);
  }

  receiveScene_(message) {
    this.served = message;
    this.firstScene ??= message.scene;
    if (isOrbit(message.scene.camera) && message.camera)
      this.orbitFrame_ = orbitFrame(message.scene.camera, message.camera);
    if (!this.moving_) this.takeServed_();
  }

  takeServed_() {
    this.doubtful_ = false;
    if (!this.served) return;
    this.scene = this.served.scene;
    this.emit("change");
  }

  /// Returns a name for edits that are undone together.
  newStep(name) {
    this.steps_ += 1;
    return `${name}-${this.page_}-${this.steps_}`;
  }

  /// Changes the scene by one edit.
  edit(patch, step = this.newStep("edit")) { this.apply_(patch, step, false); }

  /// Begins a drag: its edits are drawn as drafts and undone together.
  drag(name) {
    const step = this.newStep(name);
    let edited = false;
    return {
      edit: (patch) => {
        edited = true;
        this.moving_ = true;
        this.apply_(patch, step, true);
      },
      end: () => {
        if (!edited) return;  // a click without a move
        this.moving_ = false;
        this.pacer_.rest();
        if (this.doubtful_) this.takeServed_();
      },
    };
  }

  apply_(patch, step, moving) {
    if (!this.scene) return;
    const local = {...patch };
    // What a preset or a file stands for is known when the server has read it.
    if (typeof local.transfer === "string" || Array.isArray(local.transfer)) delete local.transfer;
    this.scene = applyPatch(this.scene, local);
    this.pacer_.edit(patch, step, moving);
    this.emit("edited", { patch, step });
    this.emit("change");
  }

  /// Sends undo, redo, reset, pause, resume, probe or save, after the edits before it.
  command(message) {
    this.pacer_.flush();
    this.moving_ = false;
    this.send_(message);
  }

  /// Asks for a frame of the sequence, or plays it: the scene, and what is being dragged of it, stays.
  sequenceCommand(message) { this.send_(message); }

  /// Asks for the histogram of value and gradient magnitude.
  askGradients() { this.send_({ type: "gradients" }); }

  /// Asks what is in a folder below that of the server.
  files(path) { this.send_({ type: "files", path }); }

  /// Asks what lies at a pixel. It is no command, since edits need not go first.
  probe(x, y) { this.send_({ type: "probe", x, y }); }

  /// Returns the scene's camera, where it stands now, and its axes; null before the first scene.
  view() {
    if (!this.scene) return null;
    const camera = this.scene.camera;
    const resolved =
        isOrbit(camera) && !this.orbitFrame_ ? this.served.camera : resolveCamera(camera, this.orbitFrame_);
    return { camera, resolved, axes: viewAxes(resolved) };
  }
}
