// Transfer functions of values that vary smoothly: fog, heat, fields of both signs; and of distances.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "render/suggest_colours.h"
#include "render/suggest_parts.h"

namespace umbrick {
namespace {

using Colour = std::function<glm::dvec3(double)>;
constexpr double kFogDepth = 2.5;  // mean optical depth of columns through fog: dense in the middle, thin at the rim

// Returns a function whose extinction grows in proportion to the value from `first` on.
TransferFunction proportional(const SuggestInput& input, double first, double last, const Colour& colour) {
  const double extent = last - first;
  const double densest =
      std::min(input.depthOf(kFogDepth, [&](double value) { return std::clamp((value - first) / extent, 0.0, 1.0); }),
               4 * input.solid());
  constexpr int kPoints = 9;
  std::vector<TransferFunction::Point> points;
  for (int i = 0; i < kPoints; ++i) {
    const double share = i / (kPoints - 1.0);
    points.push_back({first + share * extent, {colour(share), share * densest}});
  }
  return TransferFunction(std::move(points));
}

// Returns where a field begins: at the background, from which it grows.
double beginOf(const SuggestInput& input) {
  const ValueSurvey& values = input.values;
  return values.background < values.high ? values.background : values.low;
}

}  // namespace

TransferFunction suggestDensity(const SuggestInput& input, bool coloured) {
  // Droplets of water absorb next to nothing, particles of smoke a tenth of the light and more.
  const bool cloud = namesOneOf(input.volume.grid().name, {"cloud"});
  const glm::dvec3 particles = cloud ? glm::dvec3(0.99, 0.992, 0.995) : glm::dvec3(0.86, 0.87, 0.89);
  const Colour colour = [&](double share) { return coloured ? ascendingColour(share) : particles; };
  return proportional(input, beginOf(input), input.values.high, colour);
}

TransferFunction suggestHeat(const SuggestInput& input) {
  return proportional(input, beginOf(input), input.values.high, glowingColour);
}

TransferFunction suggestSigned(const SuggestInput& input, double middle) {
  const ValueSurvey& values = input.values;
  const double reach = std::max(values.high - middle, middle - values.low);
  constexpr double kClear = 0.1;  // this share of the reach on both sides of the middle is transparent
  const double densest = std::min(input.depthOf(kFogDepth,
                                                [&](double value) {
                                                  const double share = std::abs(value - middle) / reach;
                                                  return std::clamp((share - kClear) / (1 - kClear), 0.0, 1.0);
                                                }),
                                  4 * input.solid());
  std::vector<TransferFunction::Point> points;
  for (const double share : {-1.0, -0.55, -kClear, kClear, 0.55, 1.0})
    points.push_back(
        {middle + share * reach, {divergingColour(share), densest * (std::abs(share) - kClear) / (1 - kClear)}});
  return TransferFunction(std::move(points));
}

TransferFunction suggestLevelSet(const SuggestInput& input) {
  // The medium thickens across one voxel around the surface, so that there is no step to be seen.
  const double half = 0.5 * input.voxelEdge;
  const double solid = std::max(input.solid(), 2 / input.voxelEdge);
  return TransferFunction({{-half, {plainColour(), solid}}, {half, {plainColour(), 0}}});
}

}  // namespace umbrick
