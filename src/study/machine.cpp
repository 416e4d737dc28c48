// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/machine.h"

#include <tbb/info.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <string_view>

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

bool isSoftware(std::string renderer) {
  std::transform(renderer.begin(), renderer.end(), renderer.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 5> names{"llvmpipe", "softpipe", "swrast", "swiftshader", "software"};
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view name) { return renderer.find(name) != std::string::npos; });
}

}  // namespace

Machine describeMachine(const GlContext& context) {
  return {cpuModel(),
          tbb::info::default_concurrency(),
          context.description(),
          isSoftware(context.renderer()),
          UMBRICK_VERSION,
          "C++ compiler " __VERSION__,
          {}};
}

double loadAverage() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

}  // namespace umbrick
