// Work of the library beside the interpreter: without its lock, with progress, and ended by Ctrl+C.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "umbrick/core/memory.h"

namespace umbrick::python {

/// What a job sees of its caller. It is used by the job's thread.
class JobWatch {
 public:
  /// Tells how far the job is. @throw  something that ends the job, once the caller does not want it any more
  void tell(double share, const std::string& step);
  /// Does the same without an exception. @return false  the job is to end
  bool goOn(double share, const std::string& step);

 private:
  friend class JobThread;
  struct Stopped {};

  std::mutex mutex_;
  double share_ = 0;
  std::string step_;
  std::atomic<bool> stop_{false};
};

/// A thread that does jobs, one after the other. OpenGL contexts that jobs make are current on it and end with it, so
/// that objects which draw can be used from any thread of Python's.
class JobThread {
 public:
  using Job = std::function<void(JobWatch& watch)>;

  JobThread();
  /// Waits for what was posted last. @pre the caller holds the interpreter's lock
  ~JobThread();
  JobThread(const JobThread&) = delete;
  JobThread& operator=(const JobThread&) = delete;

  /// Does a job and waits for it without the interpreter's lock. Meanwhile signals are looked at some 20 times a
  /// second, and `progress` is called with the share that is done and the step at hand. What they raise ends the job
  /// as soon as it tells its progress, and is raised then.
  /// @param name      of the job, for a line on memory that is refused
  /// @param progress  a callable, or None
  /// @throw InvalidArgument  the job at hand has called this itself, by `progress`
  /// @throw Error            what the job throws
  /// @pre the caller holds the interpreter's lock
  void run(const std::string& name, const pybind11::object& progress, const Job& job);

 private:
  void work();

  std::mutex turns_;  // of callers
  std::atomic<std::thread::id> caller_{};
  std::mutex mutex_;  // of the following
  std::condition_variable changed_;
  std::function<void()> next_;
  bool done_ = true, leave_ = false;
  std::thread thread_;  // last: it uses all of the above
};

/// Does one job in a thread of its own.
void runJob(const std::string& name, const pybind11::object& progress, const JobThread::Job& job);

}  // namespace umbrick::python
