#include "umbrick/scene/lights.h"

#include "umbrick/scene/light_set.h"

namespace umbrick {

std::vector<LightDirection> lightDirections(const Scene& resolved, int count, double rotation) {
  return LightSet(resolved).directions(count, rotation);
}

std::vector<LightDirection> lightSamples(const Scene& resolved, std::uint64_t first, int count, std::uint64_t seed) {
  return LightSet(resolved).samples(first, count, seed);
}

}  // namespace umbrick
