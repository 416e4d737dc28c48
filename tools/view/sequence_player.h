// Reads the frames of a sequence that pages ask for, and plays them, in a thread of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "view/view_sequence.h"

namespace umbrick::view {

/// A frame that has been read.
struct ReadFrame {
  std::size_t index = 0;
  std::shared_ptr<const Volume> volume;  // null: the frame holds nothing
};

/// What is shown and what is going on.
struct PlayState {
  std::size_t present = 0;           // the frame that was handed out last
  std::optional<std::size_t> asked;  // the one that is being read for a page
  bool playing = false, loop = true;
  double fps = 25;       // frames a second, at most
  bool dragged = false;  // pages ask for one frame after another
  /// Whether another frame follows soon, so that drafts are enough.
  bool moves() const { return playing || dragged; }
};

/// Hands out the frame that was asked for last, or one after another while it plays, and reads the next one in the same
/// direction meanwhile. No more than two volumes are in its hands or on their way to what draws: a frame is handed out
/// when the one before has been taken, one that is played when that one has been drawn as well.
class SequencePlayer {
 public:
  /// Is called by the thread that reads, with the number of the sequence, see open(). No lock is held then.
  struct Sink {
    std::function<void(std::uint64_t, const ReadFrame&)> show;
    std::function<void(std::uint64_t, const std::string& line)> failed;  // of a frame that cannot be shown
    std::function<void(std::uint64_t)> ended;                            // play has come to its end
  };
  explicit SequencePlayer(Sink sink);
  /// As end().
  ~SequencePlayer();
  SequencePlayer(const SequencePlayer&) = delete;
  SequencePlayer& operator=(const SequencePlayer&) = delete;

  /// Shows another sequence, whose first frame is there already; null: none. Loop and speed stay.
  void open(std::shared_ptr<const ViewSequence> sequence);
  bool isCurrent(std::uint64_t number) const { return current_ == number; }
  /// Ends what is read and waits for it. Nothing is handed out any more.
  void end();

  /// Asks for a frame; what was asked for before and has not been read is given up. @pre there is a sequence
  void ask(std::size_t index, bool dragged);
  /// Plays from the present frame, at its end from the beginning, or stops. @pre there is a sequence
  void play(bool on);
  void setLoop(bool loop);
  void setRate(double fps);
  /// Nothing is dragged any more.
  void rest();
  PlayState state() const;

  /// Says that the frame that was handed out last is looked at by what draws.
  void taken();
  /// Says that a picture of it has been drawn, or cannot be.
  void drawn();

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  std::optional<std::size_t> next(int direction) const;
  std::optional<std::size_t> wanted() const;
  void hand(std::unique_lock<std::mutex>& lock);
  void read(std::unique_lock<std::mutex>& lock, std::size_t index);

  Sink sink_;
  mutable std::mutex mutex_;  // of what follows, up to due_
  std::condition_variable changed_;
  std::shared_ptr<const ViewSequence> sequence_;
  std::shared_ptr<KeptStream> kept_;  // a packed file of several frames is unpacked once
  PlayState state_;
  int direction_ = 0;  // of the last move; 0: nobody has asked for another frame
  std::set<std::size_t> bad_;
  std::optional<ReadFrame> ready_;
  bool taken_ = true, drawn_ = true;
  Clock::time_point due_;  // of the next frame that is played
  std::atomic<std::uint64_t> current_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace umbrick::view
