// Excludes pixels from the occlusion sweep that no visible sample can see any more.
#pragma once
#include "shade/frame.h"
#include "shade/screen_region.h"

namespace umbrick {

/// A saturated pixel is not done when light is carried: its occlusion spreads to neighbours that still see. But it
/// spreads as a random walk, so that what lies many standard deviations of the remaining walk away from every
/// unsaturated pixel with bricks to come cannot matter. That is decided by tiles, on the graphics side, without waiting
/// for it.
class LightNeed {
 public:
  explicit LightNeed(const GlFunctions& gl);
  /// Before the first slice. @param steps  by slice, see occlusionRegions
  void begin(const Frame& frame, std::span<const SliceStep> steps);
  /// Marks what slices from `slice` on do not need.
  void run(const Frame& frame, std::int64_t slice);

 private:
  void drawTiles(const Frame& frame, GlProgram& program, int from, int to);

  static constexpr int kTileEdge = 8;  // pixels
  GlProgram need_, dilate_, mark_;
  GlVertexArray nothing_;
  GlTexture lastSlice_;
  GlTexture tiles_[2];
  GlFramebuffer targets_[2];
  glm::ivec2 tileCount_{0};
  std::vector<double> reach_;   // of the walk from a slice to the last, pixels of the slice
  std::vector<double> growth_;  // of a distance from the image's centre, from the last slice back to a slice
};

}  // namespace umbrick
