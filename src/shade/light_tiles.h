// Finds, by tiles of the image, the work that the occlusion sweep can leave out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "shade/frame.h"
#include "shade/screen_region.h"

namespace umbrick {

/// The sweep cannot leave a pixel out as soon as it is saturated: its occlusion spreads to neighbours through which
/// one still sees. But it spreads as a random walk, so that a place does not matter which is kWalkReach deviations
/// of the remaining walk away from every unsaturated pixel with bricks to come. And where nothing is occluded,
/// nothing needs to be carried. Both are decided on the graphics side, without waiting for it, and kept in the depth
/// buffer (see tile_mark.frag).
class LightTiles {
 public:
  explicit LightTiles(const GlFunctions& gl);
  /// Is called before the first slice. @param steps  one for each slice, see occlusionRegions
  void begin(const Frame& frame, std::span<const SliceStep> steps);
  /// Sets the depth buffer for the slices from `slice` to the next look. @param occlusion  buffer of the slice before
  void look(const Frame& frame, std::int64_t slice, const GlTexture& occlusion);

  /// A look is taken every so many slices. It costs about as much as carrying light through one slice.
  static constexpr std::int64_t kInterval = 24;

 private:
  // How light spreads from one slice to a later one: its reach in pixels of the nearer slice, and the scale of
  // distances from the image's centre.
  struct Way {
    double reach = 0, scale = 1;
  };
  Way way(std::int64_t from, std::int64_t to) const;
  void dilate(int from, int to, const glm::vec2& axis, const GlFunctions& gl);

  static constexpr int kTileEdge = 8;  // pixels
  GlProgram state_, dilate_, mark_;
  GlVertexArray nothing_;
  GlTexture coveredBy_;
  GlTexture tiles_[2];
  GlFramebuffer targets_[2];
  glm::ivec2 tileCount_{0};
  std::vector<SliceStep> steps_;
};

}  // namespace umbrick
