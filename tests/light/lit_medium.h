// Media of light volumes, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>
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

/// The light of a volume, voxel by voxel.
class LitVoxels {
 public:
  LitVoxels(const Bricks& volume, const LightMedium& medium) : volume_(volume), light_(volume) {
    light_.update(medium, kPlenty);
    for (const glm::ivec3& cell : medium.cells) {
      blocks_.emplace_back(cell,
                           std::vector<float>(volume.layout.voxels() * static_cast<std::size_t>(light_.channels())));
      light_.read(cell, blocks_.back().second);
    }
  }
  double at(const glm::ivec3& voxel, int channel = 0) const {
    for (const auto& [cell, block] : blocks_) {
      const glm::ivec3 p = voxel - cell, edge = volume_.layout.edge(), i = p + volume_.layout.apron;
      if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= edge.x - 2 || p.y >= edge.y - 2 || p.z >= edge.z - 2) continue;
      const std::size_t at =
          (static_cast<std::size_t>(i.z) * static_cast<std::size_t>(edge.y) + static_cast<std::size_t>(i.y)) *
              static_cast<std::size_t>(edge.x) +
          static_cast<std::size_t>(i.x);
      return block[at * static_cast<std::size_t>(light_.channels()) + static_cast<std::size_t>(channel)];
    }
    return std::nan("");
  }
  const LightVolume& light() const { return light_; }

 private:
  const Bricks& volume_;
  LightVolume light_;
  std::vector<std::pair<glm::ivec3, std::vector<float>>> blocks_;
};

}  // namespace umbrick
