// The light that reaches the voxels of visible bricks, beside them in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "sweep/brick_voxels.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/light/light_volume.h"
#include "umbrick/scene/lights.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Computes light where it depends on what has changed, and keeps it with the bricks in 16 bits a voxel and channel.
class BrickLight {
 public:
  explicit BrickLight(const Bricks& volume) : light_(volume) {}

  /// Computes the light of a medium, whether its bricks are held or not.
  /// @param planes  the medium's or not, index coordinates: those that cut it become its own
  /// @throw InvalidArgument  more memory would be needed than the scene's budget and 2 GiB
  void update(LightMedium medium, const ResolvedScene& scene, std::span<const glm::dvec4> planes,
              const BrickLayout& layout);
  /// Stores it with the bricks that are held, where they do not have it.
  void store(BrickVoxels& voxels);

  /// Stores light again the next time: something else has taken its place beside the voxels.
  void forget() { generation_ = kNoGeneration; }

  int channels() const { return light_.channels(); }
  glm::dvec3 whole() const { return light_.whole(); }
  float unit() const { return unit_; }  // share of whole() that a code of 1 stands for
  double ms() const { return ms_; }     // of the last update, and of what was stored since
  /// Fills in what the statistics of a picture say of light.
  void addTo(RenderStats& stats) const;

 private:
  LightVolume light_;
  float unit_ = 1;
  double ms_ = 0;
  static constexpr std::uint64_t kNoGeneration = ~std::uint64_t{0};
  std::uint64_t generation_ = kNoGeneration;  // of the bricks that have light
};

}  // namespace umbrick
