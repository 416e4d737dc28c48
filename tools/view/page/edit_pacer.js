// Decides when edits are sent, so that a slow renderer or connection is never flooded: at most one message per
// animation frame, and none while more than two edits wait for a picture. Edits that have to wait are joined into one.
// SPDX-License-Identifier: Apache-2.0
import {composePatches} from "./merge_patch.js";

const kMostWithoutPicture = 2;
/// An edit may change no pixel, and then no picture follows. After so many milliseconds the next edit is sent anyway.
const kPatienceMs = 400;

export class EditPacer {
  /// @param send       called with each message that is due
  /// @param nextFrame  calls a function at the next animation frame, as requestAnimationFrame
  /// @param now        returns milliseconds
  constructor(send, nextFrame, now) {
    Object.assign(this, { send_: send, nextFrame_: nextFrame, now_: now });
    this.reset();
  }

  /// Forgets what waits, for example after the connection was lost.
  reset() {
    this.pending_ = null;
    this.restWaits_ = false;
    this.withoutPicture_ = 0;
    this.lastSent_ = -Infinity;
    this.scheduled_ = false;
    this.sentThisFrame_ = false;
  }

  /// Adds an edit. Edits of one step are one step of undo.
  edit(patch, step, moving) {
    const waiting = this.pending_;
    if (waiting) {
      const joined = waiting.step === step && !this.restWaits_ ? composePatches(waiting.patch, patch) : undefined;
      if (joined !== undefined)
        this.pending_ = { patch: joined, step, moving };
      else {
        this.flush();
        this.pending_ = { patch, step, moving };
      }
    } else
      this.pending_ = { patch, step, moving };
    this.sendIfDue_();
  }

  /// Says that a drag has ended. Its last edit goes out first, without waiting.
  rest() {
    this.restWaits_ = true;
    this.flush();
  }

  /// Sends what waits, at once; other messages call this first, so that the order is kept.
  flush() {
    if (this.pending_) this.sendPending_();
    if (this.restWaits_) {
      this.restWaits_ = false;
      this.send_({ type: "rest" });
    }
  }

  /// Says that a picture has been drawn.
  pictureShown() {
    this.withoutPicture_ = 0;
    if (this.pending_) this.sendIfDue_();
  }

  sendIfDue_() {
    const late = this.now_() - this.lastSent_ > kPatienceMs;
    if (!this.sentThisFrame_ && (this.withoutPicture_ < kMostWithoutPicture || late))
      this.sendPending_();
    else
      this.tryNextFrame_();
  }

  sendPending_() {
    const { patch, step, moving } = this.pending_;
    this.pending_ = null;
    this.lastSent_ = this.now_();
    this.withoutPicture_ += 1;
    this.sentThisFrame_ = true;
    this.tryNextFrame_();
    this.send_({ type: "edit", patch, moving, step });
  }

  tryNextFrame_() {
    if (this.scheduled_) return;
    this.scheduled_ = true;
    this.nextFrame_(() => {
      this.scheduled_ = false;
      this.sentThisFrame_ = false;
      if (this.pending_) this.sendIfDue_();
    });
  }
}
