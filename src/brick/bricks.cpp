// SPDX-License-Identifier: Apache-2.0
#include "umbrick/brick/bricks.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {
std::int64_t floorDivide(std::int64_t a, std::int64_t b) { return (a >= 0 ? a : a - b + 1) / b; }

// Prints a count that may exceed 64 bits.
std::string printCount(long double count) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << count;
  return text.str();
}
}  // namespace

IndexBox Bricks::reach() const {
  if (domain.empty()) return domain;
  return {domain.min - margin(), domain.max + margin()};
}

void requireGradients(const Bricks& bricks, GradientFilter filter) {
  if (!bricks.hasGradients) throw InvalidArgument("render: a 2D transfer function needs bricks with gradients");
  if (bricks.gradientFilter != filter)
    throw InvalidArgument("gradients: is " + std::string(nameOf(kGradientFilters, filter)) +
                          ", bricks have those of the kind " +
                          std::string(nameOf(kGradientFilters, bricks.gradientFilter)));
}

void Bricks::readEmission(const glm::ivec3&, std::span<float>) const {
  throw InvalidArgument("brick: there is no second grid that emits light");
}

std::vector<Brick> backgroundBricks(const Bricks& bricks, std::size_t limit) {
  if (bricks.domain.empty()) return {};
  const IndexBox reach = bricks.reach();
  // Cells are counted from a brick, since a lattice of one cell does not begin at 0.
  const glm::i64vec3 phase(bricks.bricks.empty() ? glm::ivec3(0) : bricks.bricks.front().origin);
  glm::i64vec3 first, last;
  long double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t interior = bricks.layout.interior[axis];
    first[axis] = floorDivide(reach.min[axis] - phase[axis], interior);
    last[axis] = floorDivide(reach.max[axis] - phase[axis], interior);
    cells *= static_cast<long double>(last[axis] - first[axis] + 1);
  }
  // All bricks lie in these cells, no two in one.
  const long double count = std::max(0.0L, cells - static_cast<long double>(bricks.bricks.size()));
  if (count > static_cast<long double>(limit))
    throw InvalidArgument("the background value " + std::to_string(bricks.background) + " fills " + printCount(count) +
                          " bricks of the volume's box, more than the limit of " + std::to_string(limit));
  std::vector<Brick> result;
  result.reserve(static_cast<std::size_t>(count));
  auto next = bricks.bricks.begin();  // bricks are in the same order as the cells
  for (std::int64_t z = first.z; z <= last.z; ++z)
    for (std::int64_t y = first.y; y <= last.y; ++y)
      for (std::int64_t x = first.x; x <= last.x; ++x) {
        const glm::ivec3 origin(phase + glm::i64vec3(x, y, z) * glm::i64vec3(bricks.layout.interior));
        if (next != bricks.bricks.end() && next->origin == origin)
          ++next;
        else
          result.push_back({origin,
                            {bricks.background, bricks.background},
                            {0, 0},
                            {bricks.emissionBackground, bricks.emissionBackground}});
      }
  return result;
}

}  // namespace umbrick
