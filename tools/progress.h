// Shows on a terminal how far a long job is, and finds out whether the user wants it to stop.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/core/stopwatch.h"

namespace umbrick::tools {

/// While an object of this class lives, the first Ctrl-C (or SIGTERM) asks the job to stop instead of
/// ending the program.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  bool requested() const;
};

/// Shows a bar with the time left on stderr, or nothing when stderr is no terminal.
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
  /// Takes the bar away, so that something can be printed.
  void clear();

 private:
  std::string label_;
  Stopwatch start_;
  double bytes_ = 0, shownMs_ = -1e9;
  bool terminal_, drawn_ = false;
};

}  // namespace umbrick::tools
