// SPDX-License-Identifier: Apache-2.0
#include "shade/light_aim.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "umbrick/core/random.h"

namespace umbrick {

LightSlope lightSlope(const glm::dvec3& towards) {
  const double along = std::max(towards.z, 1e-6);
  return {glm::dvec2(towards) / along, 1 / along};
}

AimedLight aimLight(std::span<const LightDirection> directions, const CameraFrame& axes) {
  AimedLight aimed;
  for (const LightDirection& light : directions) aimed.whole += light.radiance;
  const double power = aimed.whole.r + aimed.whole.g + aimed.whole.b;
  for (const auto& [direction, radiance] : directions) {
    aimed.paths.lights.push_back(lightSlope(
        {glm::dot(direction, axes.right), glm::dot(direction, axes.up), -glm::dot(direction, axes.forward)}));
    const double share = power > 0 ? (radiance.r + radiance.g + radiance.b) / power : 0;
    aimed.radiance.emplace_back(radiance, share);
    // Where the light has one colour a direction needs only its share.
    const glm::dvec3 tint = glm::abs(radiance - share * aimed.whole);
    aimed.coloured = aimed.coloured || std::max({tint.r, tint.g, tint.b}) > 1e-9 * power;
  }
  return aimed;
}

std::vector<glm::dvec2> shiftRoundings(std::size_t directions, const glm::dvec2& rounding) {
  std::vector<glm::dvec2> roundings(directions, glm::dvec2(kHalfRounding));
  if (rounding == glm::dvec2(0.5)) return roundings;
  // The sequence begins with the view axis, whose paths do not move across at all.
  for (std::size_t k = 0; k < directions; ++k)
    roundings[k] = glm::fract(rounding + static_cast<double>(k + 1) * kR2Step);
  return roundings;
}

}  // namespace umbrick
