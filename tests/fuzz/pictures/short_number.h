// Numbers as messages about scenes give them.
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
