// Shows how far a long job is, and finds out whether the user wants it to stop.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "progress_pace.h"
#include "stop_request.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick::tools {

/// Ends a job that the user has stopped. The message says what is kept.
struct Interrupted : Error {
  using Error::Error;
};

/// Says on stderr how far a job is and how long it will take: on a terminal in one line that is rewritten, else in
/// plain lines, the first after some ten seconds. A short job says nothing.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Begins another part of the job: its share, its rate and the time left count from here.
  /// @param bytes  that the part reads in all, unpacked; 0: no rate is shown
  void begin(std::string label, double bytes = 0);
  /// @param share  of the part that is done, in [0, 1]
  void show(double share);
  /// The same, with a word on what is done now.
  void show(double share, const std::string& step);
  /// Takes the bar away, so that something can be printed.
  void clear();

 private:
  std::string label_;
  Stopwatch job_, part_;
  double bytes_ = 0;
  ProgressPace pace_;
  bool drawn_ = false;
};

/// Returns a callback of the library that shows the share that is done, and ends the job when the user wants it to
/// stop. @param bar,stop  outlive it  @param interrupted  what is said then
std::function<void(double)> showShare(ProgressBar& bar, const StopRequest& stop, std::string interrupted);

}  // namespace umbrick::tools
