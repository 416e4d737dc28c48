// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/machine.h"

#include <tbb/info.h>

#include <cstdlib>
#include <fstream>

namespace umbrick {
namespace {

std::string cpuModel() {
  std::ifstream info("/proc/cpuinfo");
  std::string line;
  while (std::getline(info, line))
    if (line.starts_with("model name") || line.starts_with("Model")) {
      const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
      if (begin != std::string::npos) return line.substr(begin);
    }
  return "unknown";
}

}  // namespace

Machine describeMachine(const GlContext& context) {
  return {cpuModel(),
          tbb::info::default_concurrency(),
          context.description(),
          context.software(),
          UMBRICK_VERSION,
          "C++ compiler " __VERSION__,
          {}};
}

double loadAverage() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

}  // namespace umbrick
