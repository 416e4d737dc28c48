// Numbers in sentences, with a few digits.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdio>
#include <string>

namespace umbrick {

/// Returns the number with so many significant digits and without zeros at its end.
inline std::string shortNumber(double number, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, number);
  return text;
}

}  // namespace umbrick
