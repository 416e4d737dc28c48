// Finds the extremes or the mean of the values along the rays of a picture, through one run of bricks after another.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "shade/frame.h"
#include "shade/ray_runs.h"
#include "shade/resident_light.h"
#include "shade/voxel_codes.h"

namespace umbrick {

/// What all runs of a picture of values share.
struct ValueScene {
  const GlFunctions& gl;
  const ResolvedScene& scene;
  const IndexView& view;
  std::span<const glm::dvec4> planes;  // that cut the volume, view coordinates
  const Bricks& volume;
  const BrickSelection& bricks;
  const VoxelCodes& codes;
  const std::function<void(double)>& progress;
  const ResidentLight* light = nullptr;  // of surfaces; null: all of them are lit alike
  const GlTexture* ends = nullptr;       // as brick_walk.glsl reads it; null: rays end nowhere
};

/// Runs may come in any order: what each has found is brought to memory, where all of it is put together.
class ProjectionPass {
 public:
  /// Is called before the first run of a picture. @param perVoxel  slices
  void begin(const ValueScene& rays, int perVoxel);
  void draw(const ValueScene& rays, const RayFrame& frame, const RayRun& run, RenderStats& stats);
  /// Fills in the picture's colour and the layer "value".
  void show(const ResolvedScene& scene, Picture& picture) const;
  std::uint64_t bytes() const;

 private:
  /// What is known of a ray.
  struct Found {
    double best = 0;     // code, of minima with the other sign; of means the sum
    double covered = 0;  // samples of the ray that lie in bricks
    double way = 0;      // all of its samples; of means its way; 0: it meets no voxel
  };
  void collect(const GlFunctions& gl, RenderStats& stats);
  double valueOf(const Found& found) const;

  SpecialisedProgram program_{"shade/full_screen.vert", "shade/projection_march.frag"};
  std::optional<GlVertexArray> nothing_;  // an empty vertex array, since the core profile draws nothing without one
  GlTexture target_;
  GlFramebuffer framebuffer_;
  glm::ivec2 size_{0};
  SlotTable slots_;
  std::vector<Found> found_;
  Mode mode_ = Mode::mip;
  double background_ = 0;
  std::optional<VoxelCodes> codes_;
};

}  // namespace umbrick
