// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/suggest_transfer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "render/suggest_parts.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {
namespace {

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// Returns the axis of index space that runs most along the way the volume faces.
int axisOfView(const Volume& volume) {
  const glm::dvec3 front = axisDirection(volume.orientation().front);
  int best = 0;
  double most = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = std::abs(glm::dot(glm::normalize(glm::dvec3(volume.indexToWorld()[axis])), front));
    if (along > most) {
      most = along;
      best = axis;
    }
  }
  return best;
}

SuggestInput lookAt(const Volume& volume) {
  SuggestInput input{.volume = volume, .values = surveyValues(volume.grid())};
  input.voxelEdge = shortestVoxelEdge(volume.indexToWorld());
  input.diagonal = std::max(glm::length(volume.worldBounds().extent()), input.voxelEdge);
  input.axis = axisOfView(volume);
  return input;
}

// Returns the share of all voxels in the box of the volume whose values lie in an interval.
double shareIn(const ValueSurvey& values, double low, double high) {
  double count = 0;
  for (std::size_t bin = 0; bin < values.histogram.size(); ++bin)
    if (const double centre = values.binCentre(bin); centre >= low && centre < high) count += values.histogram[bin];
  if (values.background >= low && values.background < high)
    count += static_cast<double>(values.boxVoxels - std::min(values.boxVoxels, values.voxels));
  return count / static_cast<double>(std::max<std::uint64_t>(values.boxVoxels, 1));
}

// Tells a CT of which the file does not say that it is one: much of it is air, much is tissue, whose values lie around
// those of water, little lies between, and bone goes far above. @param air  the value of air
bool isLikeCt(const ValueSurvey& values, double air) {
  if (!values.wholeNumbers || values.value.min < air - 100 || values.value.min > air + 300) return false;
  if (values.value.max < air + 1300 || values.value.max > air + 8192) return false;
  const double tissue = shareIn(values, air + 900, air + 1200);
  return tissue > 0.05 && shareIn(values, air - 100, air + 200) > 0.1 &&
         shareIn(values, air + 300, air + 800) < 0.5 * tissue && shareIn(values, air + 1250, air + 9000) > 0.002;
}

// Returns the middle of values that lie on both sides of one: of 0, or of a background that much of the box has.
std::optional<double> middleOf(const ValueSurvey& values) {
  constexpr double kLeastSide = 0.1;
  std::vector<double> middles{0};
  if (values.voxels * 5 < values.boxVoxels * 4) middles.insert(middles.begin(), values.background);
  for (const double middle : middles) {
    const double below = middle - values.low, above = values.high - middle;
    if (std::min(below, above) > kLeastSide * std::max(below, above)) return middle;
  }
  return std::nullopt;
}

std::string ctUnit(const Volume& volume, const ValueSurvey& values) {
  const std::string modality = lowerCase(volume.grid().metadata("modality"));
  const bool ct = modality.find("ct") != std::string::npos;
  if (!volume.valueUnit().empty()) return volume.valueUnit();
  if (ct && values.value.min < -200) return std::string(kHounsfield);
  if (volume.foreign() || volume.grid().isLevelSet()) return {};
  if (isLikeCt(values, -1000)) return std::string(kHounsfield);
  return isLikeCt(values, 0) ? std::string(kShiftedHounsfield) : std::string();
}

}  // namespace

bool namesOneOf(const std::string& name, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return lowerCase(name).find(word) != std::string::npos; });
}

std::string ctUnit(const Volume& volume) {
  return volume.valueUnit().empty() ? ctUnit(volume, surveyValues(volume.grid())) : volume.valueUnit();
}

TransferFunction fitted(const TransferFunction& transfer, const Volume& volume) {
  return transfer.unit().empty() ? transfer : inUnit(transfer, ctUnit(volume));
}

SuggestedTransfer suggestTransfer(const Volume& volume) {
  const SuggestInput input = lookAt(volume);
  const ValueSurvey& values = input.values;
  const std::string& name = volume.grid().name;
  if (volume.grid().isLevelSet()) return {suggestLevelSet(input), VolumeKind::levelSet, "a level set: its surface"};
  const bool scan = !volume.foreign() && !volume.grid().metadata("source_format").empty();
  if (const std::string unit = ctUnit(volume, values); unit == kHounsfield || unit == kShiftedHounsfield)
    return {suggestCt(input, unit == kHounsfield ? -1000 : 0).withUnit(unit), VolumeKind::ct,
            (volume.valueUnit().empty() ? "values like those of a CT in " : "CT in ") + unit +
                ": air away, tissue faint, bone solid"};
  if (const auto labels = suggestLabels(input))
    return {*labels, VolumeKind::labels,
            values.distinct.size() > 2 ? "whole numbers in any order: labels, a colour each" : "a mask: its surface"};
  if (namesOneOf(name, {"temperature", "heat", "flame", "fire", "fuel"}) && values.value.min >= 0)
    return {suggestHeat(input), VolumeKind::heat, "heat: denser and brighter with the value"};
  if (const auto middle = middleOf(values))
    if (!scan || !values.wholeNumbers)
      return {suggestSigned(input, *middle), VolumeKind::signedField, "values on both sides of a middle: two colours"};
  if (volume.foreign()) return {suggestDensity(input, false), VolumeKind::density, "fog: as dense as its values"};
  if (const auto materials = suggestMaterials(input))
    return {*materials, VolumeKind::materials, "regions of one value each: the outer faint, the innermost solid"};
  return {suggestDensity(input, true), VolumeKind::density, "a field without regions: denser with the value"};
}

}  // namespace umbrick
