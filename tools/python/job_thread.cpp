// SPDX-License-Identifier: Apache-2.0
#include "job_thread.h"

#include <chrono>
#include <exception>
#include <optional>
#include <utility>

namespace umbrick::python {
namespace py = pybind11;

void JobWatch::tell(double share, const std::string& step) {
  if (!goOn(share, step)) throw Stopped{};
}

bool JobWatch::goOn(double share, const std::string& step) {
  const std::lock_guard lock(mutex_);
  share_ = share;
  if (step_ != step) step_ = step;
  return !stop_;
}

JobThread::JobThread() : thread_([this] { work(); }) {}

JobThread::~JobThread() {
  const py::gil_scoped_release unlocked;
  {
    const std::lock_guard lock(mutex_);
    leave_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void JobThread::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return next_ || leave_; });
    if (!next_) return;
    const std::function<void()> job = std::exchange(next_, {});
    lock.unlock();
    job();
    lock.lock();
    done_ = true;
    changed_.notify_all();
  }
}

void JobThread::run(const std::string& name, const py::object& progress, const Job& job) {
  if (caller_ == std::this_thread::get_id())
    throw InvalidArgument(name + ": expected a progress callback that draws nothing itself, found one that does");
  JobWatch watch;
  std::exception_ptr failed;
  std::optional<py::error_already_set> raised;
  std::unique_lock<std::mutex> turn;
  {
    const py::gil_scoped_release unlocked;
    turn = std::unique_lock(turns_);
    caller_ = std::this_thread::get_id();
    const std::lock_guard lock(mutex_);
    done_ = false;
    next_ = [&] {
      try {
        withinMemory([&] { return name; }, [&] { job(watch); });
      } catch (const JobWatch::Stopped&) {
        // The caller knows why.
      } catch (...) {
        failed = std::current_exception();
      }
    };
  }
  changed_.notify_all();

  constexpr std::chrono::milliseconds kLook{50};
  double told = -1;
  std::string toldStep;
  for (bool done = false; !done;) {
    {
      const py::gil_scoped_release unlocked;
      std::unique_lock lock(mutex_);
      done = changed_.wait_for(lock, kLook, [this] { return done_; });
    }
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      double share = 0;
      std::string step;
      {
        const std::lock_guard lock(watch.mutex_);
        share = watch.share_;
        step = watch.step_;
      }
      if (!progress.is_none() && !step.empty() && (share != told || step != toldStep)) {
        progress(share, step);
        told = share;
        toldStep = step;
      }
    } catch (py::error_already_set& error) {
      raised.emplace(std::move(error));
      watch.stop_ = true;
    }
  }
  caller_ = std::thread::id{};
  turn.unlock();
  if (raised) throw py::error_already_set(std::move(*raised));
  if (failed) std::rethrow_exception(failed);
}

void runJob(const std::string& name, const py::object& progress, const JobThread::Job& job) {
  JobThread thread;
  thread.run(name, progress, job);
}

}  // namespace umbrick::python
