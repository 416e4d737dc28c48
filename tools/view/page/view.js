// The page of `umbrick view`: connects what the server says with what is shown, and what is done with what is sent.
// SPDX-License-Identifier: Apache-2.0
import {ClipHandles} from "./clip_handles.js";
import {Connection} from "./connection.js";
import {EditPacer} from "./edit_pacer.js";
import {filesDialog} from "./files_dialog.js";
import {helpDialog} from "./help_dialog.js";
import {Keys} from "./keys.js";
import {Notices} from "./notices.js";
import {drawScaleBar, drawTriad} from "./overlay.js";
import {buildPanels} from "./panels.js";
import {Picture} from "./picture.js";
import {PictureInput} from "./picture_input.js";
import {sequenceBar} from "./sequence_bar.js";
import {Session} from "./session.js";
import {probeWords, statusWords} from "./words.js";

const at = (id) => document.getElementById(id);
const notices = new Notices(at("notices"));
const problem = (text) => notices.error(text);

const send = (message) => connection.send(message);
const pacer = new EditPacer(send, (step) => requestAnimationFrame(step), () => performance.now());
const session = new Session(send, pacer);
const picture = new Picture(at("stage"), at("picture"), session, problem);
new PictureInput(picture, session);
const clipHandles = new ClipHandles(at("clip"), picture, session);
picture.onFit = () => session.scene && clipHandles.update();

const help = helpDialog();
const files = filesDialog(session, notices);
document.body.append(help, ...files.nodes);
let paused = false, panels = null, closePanels = null, sizeWasReset = false, refreshDue = false;
const actions = {
  undo: () => session.command({ type: "undo" }),
  redo: () => session.command({ type: "redo" }),
  reset: () => {
    session.command({ type: "reset" });
    sizeWasReset = true;
  },
  pause: () => session.command({ type: paused ? "resume" : "pause" }),
  help: () => (help.open ? help.close() : help.showModal()),
  open: () => files.show(),
};
const keys = new Keys(session, {...actions, ...sequenceBar(at("sequence"), session) });
for (const [name, action] of Object.entries(actions)) at(name).addEventListener("click", action);
at("turntable").addEventListener("click", () => keys.turn(!keys.turning));
session.on("turntable", (on) => at("turntable").setAttribute("aria-pressed", on));

let greeting = "", shownVolume = "";
session.on("hello", (hello) => {
  const { volume, version, sequence } = hello;
  // After a lost connection the same server greets in the same words. Another program needs another page.
  const words = JSON.stringify({...hello, engine: "", volume: null, sequence: null });
  if (greeting && words !== greeting) location.reload();
  greeting = words;
  const about = JSON.stringify([volume, sequence]);
  if (shownVolume && about !== shownVolume) {
    // Another volume keeps the page: its scene follows, and the panels are made for it.
    closePanels?.();
    panels = null;
    keys.turn(false);
    session.forget();
  }
  shownVolume = about;
  document.title = `${volume.file.split("/").at(-1)} - Umbrick`;
  at("program").title = `Umbrick ${version}`;
  at("open").hidden = !hello.folder;
});
session.on("scene", ({ canUndo, canRedo }) => {
  at("undo").disabled = !canUndo;
  at("redo").disabled = !canRedo;
  // The scene as it was at the start has the size of that time, not the window's.
  if (sizeWasReset) picture.askForWindowSize();
  sizeWasReset = false;
});
const refresh = () => {
  refreshDue = false;
  if (!panels || !session.scene) return;  // of a volume that is not shown any more
  panels.update();
  const view = session.view();
  clipHandles.update();
  drawTriad(at("axes"), view.axes);
  drawScaleBar(at("scale"), view, at("picture").clientHeight);
};
session.on("change", () => {
  if (!session.hello || !session.scene) return;
  if (!panels) {
    [panels, closePanels] = session.collect(() => buildPanels(at("panel"), session, picture, notices));
    session.emit("change");
    picture.askForWindowSize();
  }
  // Several edits may come between two frames of the screen, and server and page may share a processor.
  if (!refreshDue) requestAnimationFrame(refresh);
  refreshDue = true;
});
session.on("status", (status) => {
  paused = status.paused;
  at("pause").textContent = paused ? "Go on" : "Pause";
  at("status").textContent = at("status").title = statusWords(status);
  Object.assign(at("status").dataset, { draft: status.draft, done: status.done, samples: status.samples });
});
session.on("probe", (probe) => (at("probe").textContent = probeWords(probe, session.hello?.volume.unit)));
session.on("probeLeft", () => (at("probe").textContent = ""));
session.on("saved", ({ path }) => notices.note(`Saved ${path}`));
session.on("note", ({ text }) => notices.note(text));
session.on("error", ({ message }) => problem(message));

let countdown = 0;
const showLost = (seconds) => {
  clearInterval(countdown);
  const until = performance.now() + 1000 * seconds;
  const say = () => {
    const left = Math.max(0, Math.ceil((until - performance.now()) / 1000));
    at("lost-text").textContent = `The connection to the server is lost. Next try in ${left} s.`;
  };
  say();
  countdown = setInterval(say, 500);
  at("lost").hidden = false;
};

const connection = new Connection({
  message: (message) => session.receive(message),
  frame: async (frame) => {
    await picture.show(frame);
    send({ type: "shown", frame: frame.header.frame });
    pacer.pictureShown();
  },
  opened: () => {
    clearInterval(countdown);
    at("lost").hidden = true;
    pacer.reset();
    picture.forget();
  },
  lost: (seconds) => {
    keys.turn(false);
    showLost(seconds);
  },
  problem,
});
at("retry").addEventListener("click", () => connection.retryNow());
