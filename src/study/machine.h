// Where a study runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/gl/context.h"

namespace umbrick {

struct Machine {
  std::string cpu;       // model name
  int cores = 0;         // that threads may run on
  std::string renderer;  // GlContext::description()
  bool software = true;  // OpenGL draws on the CPU
  std::string version;   // of this project
  std::string compiler, gnuplot;
  bool operator==(const Machine&) const = default;
};

/// @param gnuplot  its version
Machine describeMachine(const GlContext& context, const std::string& gnuplot);
/// 1-minute load average; 0 where the system does not tell.
double loadAverage();

}  // namespace umbrick
