// SPDX-License-Identifier: Apache-2.0
#include "ingest/slicer_segments.h"

#include <algorithm>
#include <optional>

#include "ingest/header_text.h"

namespace umbrick {
namespace {

std::optional<glm::dvec3> slicerColour(const std::string& text) {
  const std::vector<std::string> parts = words(text);
  glm::dvec3 colour(0);
  for (int i = 0; i < 3; ++i) {
    const auto part = parts.size() == 3 ? number(parts[static_cast<std::size_t>(i)]) : std::nullopt;
    if (!part || !(*part >= 0 && *part <= 1)) return std::nullopt;
    colour[i] = *part;
  }
  return colour;
}

}  // namespace

std::vector<VolumeLabel> slicerSegments(const std::map<std::string, std::string>& metadata) {
  std::vector<VolumeLabel> labels;
  const auto field = [&](std::size_t i, const char* key) {
    const auto found = metadata.find("Segment" + std::to_string(i) + "_" + key);
    return found == metadata.end() ? std::string() : std::string(trimmed(found->second));
  };
  // There is at least one key for each segment.
  for (std::size_t i = 0; i < metadata.size(); ++i) {
    const auto value = integer(field(i, "LabelValue"));
    if (!value) continue;
    VolumeLabel label;
    label.name = field(i, "Name");
    label.value = *value;
    label.component = std::max<std::int64_t>(integer(field(i, "Layer")).value_or(0), 0);
    label.colour = slicerColour(field(i, "Color"));
    labels.push_back(std::move(label));
  }
  return labels;
}

}  // namespace umbrick
