// How far a check is, and its end where it is not to go on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <functional>
#include <string>

namespace umbrick {

/// Is thrown through a check that is not to go on.
struct CheckStopped {};

/// The steps of a check. Each takes some work, of which only ratios matter.
class CheckSteps {
 public:
  using Progress = std::function<bool(const std::string& step, double done)>;
  explicit CheckSteps(const Progress& progress) : progress_(progress) {}

  /// Says how much work all steps are together.
  void expect(double work) { work_ = work; }
  /// Begins a step. @throw CheckStopped
  void begin(const std::string& step, double work) {
    done_ += current_;
    current_ = work;
    step_ = step;
    within(0);
  }
  /// Says which share of the present step is done. @throw CheckStopped
  void within(double share) const {
    if (progress_ && !progress_(step_, std::min(1.0, (done_ + share * current_) / work_))) throw CheckStopped{};
  }

 private:
  const Progress& progress_;
  double work_ = 1, done_ = 0, current_ = 0;
  std::string step_;
};

}  // namespace umbrick
