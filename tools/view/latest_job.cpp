// SPDX-License-Identifier: Apache-2.0
#include "view/latest_job.h"

#include <utility>

namespace umbrick::view {

LatestJob::LatestJob() : thread_([this] { run(); }) {}

LatestJob::~LatestJob() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::uint64_t LatestJob::start(Job job) {
  const std::lock_guard lock(mutex_);
  next_ = std::move(job);
  changed_.notify_all();
  return ++current_;
}

void LatestJob::drop() {
  const std::lock_guard lock(mutex_);
  ++current_;
  next_ = nullptr;
}

void LatestJob::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (!next_) {
      changed_.wait(lock);
      continue;
    }
    const Job job = std::exchange(next_, nullptr);
    const std::uint64_t number = current_;
    lock.unlock();
    job(number);
    lock.lock();
  }
}

}  // namespace umbrick::view
