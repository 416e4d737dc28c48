// Numbers as messages about scenes give them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdio>
#include <string>

namespace umbrick {

/// Three digits: tells scenes and errors apart, not more.
inline std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace umbrick
