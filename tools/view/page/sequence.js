// The frames of a sequence by their numbers, and how often a page asks for one while a slider is dragged.
// SPDX-License-Identifier: Apache-2.0

/// The numbers of frames, in ascending order, of which some may be missing.
export class FrameNumbers {
  /// @param ranges  as hello has them: each is [first, last]
  /// @param step    between the numbers of a range
  constructor({ranges, step}) {
    Object.assign(this, { ranges_: ranges, step_: step });
    this.first = ranges[0][0];
    this.last = ranges.at(-1)[1];
    this.count = ranges.reduce((sum, range) => sum + this.countOf_(range), 0);
  }

  countOf_([first, last]) { return (last - first) / this.step_ + 1; }

  /// Returns the number of a frame that is counted from 0.
  at(index) {
    let left = Math.min(Math.max(index, 0), this.count - 1);
    for (const range of this.ranges_) {
      if (left < this.countOf_(range)) return range[0] + left * this.step_;
      left -= this.countOf_(range);
    }
    return this.last;
  }

  /// Returns which frame has the number that is nearest to this one, the lower of two.
  nearest(number) {
    let before = 0, best = 0;
    for (const range of this.ranges_) {
      const most = this.countOf_(range) - 1;
      const index = before + Math.min(most, Math.max(0, Math.ceil((number - range[0]) / this.step_ - 0.5)));
      if (Math.abs(this.at(index) - number) < Math.abs(this.at(best) - number)) best = index;
      before += most + 1;
    }
    return best;
  }

  /// Returns the number of the frame that follows one, or stands before it (by = -1); at an end the one at the other
  /// end, or where there is no loop the same.
  beside(number, by, loop) {
    const index = this.nearest(number) + by;
    if (index < 0 || index >= this.count) return loop ? this.at(index < 0 ? this.count - 1 : 0) : number;
    return this.at(index);
  }

  /// "1-24", or "0-20:2", as umbrick render takes it.
  get words() { return `${this.first}-${this.last}${this.step_ > 1 ? `:${this.step_}` : ""}`; }
}

/// Asks for frames at most once per animation frame while a slider moves, for the last one of that time. The end of a
/// drag goes out at once.
export class FrameAsker {
  /// @param send       sends a message
  /// @param nextFrame  calls a function at the next animation frame, as requestAnimationFrame
  constructor(send, nextFrame) {
    Object.assign(this, { send_: send, nextFrame_: nextFrame, pending_: null, scheduled_: false });
  }

  drag(number) {
    this.pending_ = number;
    if (this.scheduled_) return;
    this.scheduled_ = true;
    this.nextFrame_(() => {
      this.scheduled_ = false;
      if (this.pending_ !== null) this.send_({ type: "sequence", number: this.pending_, moving: true });
      this.pending_ = null;
    });
  }

  ask(number) {
    this.pending_ = null;
    this.send_({ type: "sequence", number, moving: false });
  }
}
