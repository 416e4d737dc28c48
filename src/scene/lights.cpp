// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/lights.h"

#include "umbrick/scene/light_set.h"

namespace umbrick {

std::vector<LightDirection> lightDirections(const ResolvedScene& scene, int count, double rotation) {
  return LightSet(scene).directions(count, rotation);
}

std::vector<LightDirection> lightSamples(const ResolvedScene& scene, std::uint64_t first, int count,
                                         std::uint64_t seed) {
  return LightSet(scene).samples(first, count, seed);
}

}  // namespace umbrick
