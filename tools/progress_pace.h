// When and in which words to say how far a job is. Pure functions and counters: the time comes from outside.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace umbrick::tools {

enum class ProgressStyle {
  none,       // nothing
  rewritten,  // one line of a terminal, which is rewritten
  lines,      // plain lines now and then, for a log
  steps,      // a plain line for each part of the job and each tenth of it, at once
};

/// Returns what fits: what the environment variable UMBRICK_PROGRESS asks for ("none", "steps"), or else what suits
/// stderr. @param wish  of the variable; null: not set
ProgressStyle progressStyle(const char* wish, bool terminal);

/// Decides when to say something, so that a short job says nothing.
class ProgressPace {
 public:
  explicit ProgressPace(ProgressStyle style) : style_(style) {}
  ProgressStyle style() const { return style_; }
  /// Begins another part of the job.
  void begin() { tenths_ = -1; }
  /// Tells whether it is time to say something, which is then taken as said.
  /// @param elapsedMs  since the job began  @param share  of the part that is done
  bool isDue(double elapsedMs, double share);

 private:
  ProgressStyle style_;
  double saidMs_ = -1;  // when something was said last; negative: never
  int tenths_ = -1;     // of the part that were done then
};

/// Returns "1:05", or "2:01:05" from an hour on.
std::string minutes(double seconds);

/// Returns "converting head.nrrd: 12 %, 310 MB/s, 1:05 left" for plain lines, or the same with a bar.
/// @param elapsedMs  since the part began
/// @param bytes      that the part reads in all; 0: no rate is shown
std::string progressText(ProgressStyle style, const std::string& label, double share, double elapsedMs, double bytes);

}  // namespace umbrick::tools
