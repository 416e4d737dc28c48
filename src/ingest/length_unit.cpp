// SPDX-License-Identifier: Apache-2.0
#include "ingest/length_unit.h"

#include <array>
#include <utility>

#include "ingest/header_text.h"

namespace umbrick {

std::optional<double> millimetresPer(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 23> kUnits{{
      {"mm", 1},           {"millimeter", 1},  {"millimeters", 1},   {"millimetre", 1},    {"millimetres", 1},
      {"cm", 10},          {"centimeter", 10}, {"centimetre", 10},   {"m", 1000},          {"meter", 1000},
      {"metre", 1000},     {"um", 1e-3},       {"\u00b5m", 1e-3},    {"\u03bcm", 1e-3},    {"\xb5m", 1e-3},
      {"micron", 1e-3},    {"microns", 1e-3},  {"micrometer", 1e-3}, {"micrometre", 1e-3}, {"nm", 1e-6},
      {"nanometer", 1e-6}, {"inch", 25.4},     {"pm", 1e-9},
  }};
  const std::string name = lower(unit);
  return valueNamed(kUnits, name);
}

std::string spaceName(std::string_view name) {
  const std::string text = lower(name);
  if (text == "left-posterior-superior" || text == "lps") return "LPS";
  if (text == "right-anterior-superior" || text == "ras") return "RAS";
  if (text == "left-anterior-superior" || text == "las") return "LAS";
  return std::string(name);
}

}  // namespace umbrick
