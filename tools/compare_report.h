// What `umbrick compare` measures of each layer, its limits, and how both are printed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/image/image_difference.h"

namespace umbrick::tools {

struct LayerDifference {
  std::string name;
  int channels = 0;
  ImageDifference difference;
};

/// One number that a comparison gives.
struct Measure {
  const char* key;     // in JSON
  const char* title;   // in the table and in messages
  const char* option;  // name of the option that limits it
  const char* help;
  bool higherIsBetter;
  std::optional<double> (*of)(const ImageDifference&);
};
extern const std::array<Measure, 7> kMeasures;

/// The limit of each measure, in the order of kMeasures.
using Limits = std::array<std::optional<double>, kMeasures.size()>;

/// The result for a measure of a layer that has a limit.
struct Verdict {
  std::string layer;
  const Measure* measure;
  double value, limit;
  bool passed;  // false wherever a value is finite in one picture only
};

/// Compares each layer with the limit of each measure that it has.
/// @throw InvalidArgument  no layer has the measure of a limit
std::vector<Verdict> judge(const std::vector<LayerDifference>& layers, const Limits& limits);

struct Comparison {
  std::string test, reference;  // names of the files
  glm::ivec2 size{0};           // pixels
  DifferenceOptions options;
  std::vector<LayerDifference> layers;
  std::vector<Verdict> verdicts;
};

void printTable(const Comparison& comparison);
void printJson(const Comparison& comparison);
/// Prints one line to stderr for each limit that is not kept, and for each layer that fails since it has values which
/// are finite in one picture only.
void complain(const Comparison& comparison);

}  // namespace umbrick::tools
