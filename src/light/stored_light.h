// Light as it is kept: 16 bits a place and channel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/large_vector.h"
#include "light/slice_planes.h"

namespace umbrick {

/// The light of bricks. A code is a share of the whole light in units of unit(); 0 stands for a place without medium
/// near it, whose light nobody knows, and what is dark has a code of 1.
class StoredLight {
 public:
  /// Takes over the sums of bricks, in their order.
  void store(const SweptBricks& bricks, std::vector<glm::ivec3> origins);
  /// Takes other bricks, and adds the sums of some of them: what changed there. Light that is kept is scaled by
  /// channel. A code is then off by half a unit more than before.
  void change(const SweptBricks& changed, std::vector<glm::ivec3> origins, const glm::dvec3& scale);

  bool empty() const { return origins_.empty(); }
  float unit() const { return unit_; }
  int spacing() const { return light_.spacing; }
  std::uint64_t bytes() const { return codes_.size() * sizeof(std::uint16_t); }

  /// Reads a brick's light at each of its voxels, see LightVolume::read(). Between places of light it is the mean of
  /// those around that are known. @throw InvalidArgument
  void read(const glm::ivec3& origin, std::span<float> light) const;

  /// Estimates by how much light at every second voxel is off against light at each, root mean square over the voxels:
  /// from what the mean of places twice and four times as far apart is off. An error that falls from four to two times
  /// the distance by a factor is taken to fall by the same factor once more, at most by the 4 of the second order. 0
  /// where there is light at every voxel.
  double spacingError() const;

 private:
  std::size_t find(const glm::ivec3& origin) const;  // origins_.size(): none
  std::size_t perBrick() const { return light_.places() * static_cast<std::size_t>(channels_); }
  BrickLayout layout_;
  LightLayout light_;
  int channels_ = 1;
  float unit_ = 1;
  std::vector<glm::ivec3> origins_;  // ascending in z, then y, then x
  LargeVector<std::uint16_t> codes_;
};

/// The order of bricks.
bool comesBefore(const glm::ivec3& a, const glm::ivec3& b);

}  // namespace umbrick
