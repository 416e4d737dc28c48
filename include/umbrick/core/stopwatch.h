// Wall-clock time of a stage.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstddef>

namespace umbrick {

class Stopwatch {
 public:
  double elapsedMs() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns the highest resident memory of this process so far, in bytes; 0 where the system does not tell.
std::size_t peakMemoryBytes();

}  // namespace umbrick
