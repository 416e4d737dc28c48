// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/stopwatch.h"

#include <sys/resource.h>

namespace umbrick {

std::size_t peakMemoryBytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace umbrick
