// Describes the machine that a study runs on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/gl/context.h"

namespace umbrick {

struct Machine {
  std::string cpu;       // model name
  int cores = 0;         // how many threads run at once
  std::string renderer;  // GlContext::description()
  bool software = true;  // OpenGL draws on the CPU
  std::string version;   // of this project
  std::string compiler;
  std::string plotter;  // what plots of the study are drawn with; see StudyOptions
  bool operator==(const Machine&) const = default;
};

/// Returns a description of this machine, without a plotter.
Machine describeMachine(const GlContext& context);
/// Returns the 1-minute load average; 0 where the system does not tell.
double loadAverage();

}  // namespace umbrick
