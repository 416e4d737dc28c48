// A thread for long jobs beside the picture: one at a time, and a newer one takes the place of the one before.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace umbrick::view {

class LatestJob {
 public:
  /// A job is given its number, and asks isCurrent() now and then. It lets no exception out.
  using Job = std::function<void(std::uint64_t number)>;

  LatestJob();
  /// Drops the job and waits until it has noticed.
  ~LatestJob();
  LatestJob(const LatestJob&) = delete;
  LatestJob& operator=(const LatestJob&) = delete;

  /// Begins a job once the one before, which is dropped, has ended. @return its number
  std::uint64_t start(Job job);
  /// Drops the job that there is, and does not wait for it.
  void drop();
  /// Returns whether a job was neither dropped nor followed by another one.
  bool isCurrent(std::uint64_t number) const { return !stop_ && current_ == number; }

 private:
  void run();

  std::mutex mutex_;  // of next_
  std::condition_variable changed_;
  Job next_;
  std::atomic<std::uint64_t> current_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace umbrick::view
