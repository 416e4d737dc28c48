// SPDX-License-Identifier: Apache-2.0
#include "view/sequence_player.h"

#include <algorithm>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/ingest/volume_parts.h"

namespace umbrick::view {
namespace {

// Ends the reading of a frame that nobody waits for any more.
struct NotWanted : Error {
  using Error::Error;
};

}  // namespace

SequencePlayer::SequencePlayer(Sink sink) : sink_(std::move(sink)), thread_([this] { run(); }) {}

SequencePlayer::~SequencePlayer() { end(); }

void SequencePlayer::end() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SequencePlayer::open(std::shared_ptr<const ViewSequence> sequence) {
  const std::lock_guard lock(mutex_);
  sequence_ = std::move(sequence);
  // Only frames of one file go on where the one before ended.
  kept_ = sequence_ && sequence_->inside ? keepStream() : nullptr;
  state_.present = sequence_ ? sequence_->first : 0;
  state_.asked.reset();
  state_.playing = state_.dragged = false;
  direction_ = 0;
  bad_.clear();
  ready_.reset();
  taken_ = drawn_ = true;
  ++current_;
  changed_.notify_all();
}

void SequencePlayer::ask(std::size_t index, bool dragged) {
  const std::lock_guard lock(mutex_);
  state_.dragged = dragged;
  state_.asked.reset();
  bad_.erase(index);  // it may be there by now
  if (index != state_.present) state_.asked = index;
  changed_.notify_all();
}

void SequencePlayer::play(bool on) {
  const std::lock_guard lock(mutex_);
  if (on && !state_.playing) {
    direction_ = 1;
    due_ = Clock::now();
    if (!next(1) && state_.present != 0) state_.asked = 0;
  }
  state_.playing = on;
  changed_.notify_all();
}

void SequencePlayer::setLoop(bool loop) {
  const std::lock_guard lock(mutex_);
  state_.loop = loop;
  changed_.notify_all();
}

void SequencePlayer::setRate(double fps) {
  const std::lock_guard lock(mutex_);
  state_.fps = fps;
  due_ = Clock::now();
  changed_.notify_all();
}

void SequencePlayer::rest() {
  const std::lock_guard lock(mutex_);
  state_.dragged = false;
}

PlayState SequencePlayer::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void SequencePlayer::taken() {
  const std::lock_guard lock(mutex_);
  taken_ = true;
  changed_.notify_all();
}

void SequencePlayer::drawn() {
  const std::lock_guard lock(mutex_);
  if (!taken_) return;  // this was the frame before
  drawn_ = true;
  changed_.notify_all();
}

// The next frame that can be shown; none where there is no other one.
std::optional<std::size_t> SequencePlayer::next(int direction) const {
  const std::size_t count = sequence_->frames.size();
  for (std::size_t index = state_.present, tried = 1; tried < count; ++tried) {
    const bool atEnd = direction > 0 ? index + 1 == count : index == 0;
    if (atEnd && !state_.loop) return std::nullopt;
    index = direction > 0 ? (index + 1) % count : (index + count - 1) % count;
    if (!bad_.contains(index)) return index;
  }
  return std::nullopt;
}

// The frame that is to be shown next; none where nobody waits for one.
std::optional<std::size_t> SequencePlayer::wanted() const {
  if (state_.asked) return state_.asked;
  return state_.playing ? next(1) : std::nullopt;
}

void SequencePlayer::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (!sequence_) {
      changed_.wait(lock);
      continue;
    }
    const std::optional<std::size_t> wanted = this->wanted();
    if (state_.playing && !wanted) {
      state_.playing = false;
      const std::uint64_t number = current_;
      lock.unlock();
      sink_.ended(number);
      lock.lock();
      continue;
    }
    const std::optional<std::size_t> index = wanted || direction_ == 0 ? wanted : next(direction_);
    if (!index || (ready_ && ready_->index == *index && !wanted)) {
      changed_.wait(lock);
    } else if (!ready_ || ready_->index != *index) {
      read(lock, *index);
    } else if (!taken_ || (!state_.asked && !drawn_)) {
      changed_.wait(lock);
    } else if (!state_.asked && Clock::now() < due_) {
      changed_.wait_until(lock, due_);
    } else {
      hand(lock);
    }
  }
}

void SequencePlayer::hand(std::unique_lock<std::mutex>& lock) {
  const ReadFrame frame = *std::exchange(ready_, std::nullopt);
  if (state_.asked)
    direction_ = frame.index > state_.present || state_.playing ? 1 : -1;
  else
    direction_ = 1;
  state_.asked.reset();
  state_.present = frame.index;
  taken_ = drawn_ = false;
  // A frame that was late does not make those behind it follow faster.
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / state_.fps));
  due_ = std::max(due_, Clock::now() - period) + period;
  const std::uint64_t number = current_;
  lock.unlock();
  sink_.show(number, frame);
  lock.lock();
}

void SequencePlayer::read(std::unique_lock<std::mutex>& lock, std::size_t index) {
  ready_.reset();
  const std::shared_ptr<const ViewSequence> sequence = sequence_;
  const std::shared_ptr<KeptStream> kept = kept_;
  const std::uint64_t number = current_;
  lock.unlock();
  const auto look = [&](double) {
    const std::lock_guard looking(mutex_);
    if (stop_ || current_ != number || (state_.asked && *state_.asked != index)) throw NotWanted("not wanted");
  };
  const ViewSequence::Frame& frame = sequence->frames[index];
  std::shared_ptr<const Volume> volume;
  std::optional<std::string> failure;
  bool dropped = false;
  try {
    volume = std::make_shared<const Volume>(frame.volume, look, kept);
    if (sequence->check) sequence->check(*volume);
  } catch (const EmptyVolume&) {
    // is shown as what it is
  } catch (const NotWanted&) {
    dropped = true;
  } catch (const std::exception& error) {
    failure = "frame " + std::to_string(frame.number) + ": " + error.what();
  }
  lock.lock();
  if (dropped || current_ != number) return;
  if (!failure) {
    ready_ = ReadFrame{index, std::move(volume)};
    return;
  }
  bad_.insert(index);
  if (state_.asked == index) state_.asked.reset();
  lock.unlock();
  sink_.failed(number, *failure);
  lock.lock();
}

}  // namespace umbrick::view
