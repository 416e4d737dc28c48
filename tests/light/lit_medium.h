// Media of light volumes, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "umbrick/light/light_volume.h"

namespace umbrick {

/// More memory than any test needs, bytes.
inline constexpr std::uint64_t kPlenty = std::uint64_t{1} << 32;

inline TransferFunction proportional(double sigma_t) {
  return TransferFunction({{0, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), sigma_t}}});
}

/// The bricks that a function shows, under lights.
inline LightMedium mediumOf(const Bricks& volume, const TransferFunction& transfer,
                            std::vector<LightDirection> directions) {
  LightMedium medium{transfer, std::move(directions), {}, {}};
  for (const Brick& brick : volume.bricks)
    if (!transfer.isTransparent(brick.value)) medium.cells.push_back(brick.origin);
  return medium;
}

}  // namespace umbrick
