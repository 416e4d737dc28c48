// Pictures of values by rays on OpenGL: projections and isosurfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "shade/projection_pass.h"
#include "shade/surface_pass.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/hybrid_picture.h"

namespace umbrick {

/// Renders the modes that look at values and not at a medium, of which it holds the bricks whatever the transfer
/// function shows. It is what ValueRays are on the CPU, and samples as they do.
class ValueCaster {
 public:
  /// @param resident  outlives this
  ValueCaster(ResidentVolume& resident, const RenderOptions& options);

  /// Takes another scene, or changes nothing where this throws.
  /// @throw InvalidArgument  surfaces of values that the volume does not have; no light to reflect
  void update(const ResolvedScene& next);
  /// @param ends  as brick_walk.glsl reads it; null: rays end nowhere
  void draw(const ResolvedScene& scene, const RenderSample& sample, const GlTexture* ends);
  Picture read(const ResolvedScene& scene);
  /// Reads the first surface of each ray, of a scene of the mode hybrid. @pre draw()
  FirstSurfaces readFirst(const ResolvedScene& scene);

 private:
  // What bricks are selected for.
  struct Wanted {
    bool surfaces = false, culling = true;
    bool lit = false;            // the light that reaches surfaces lies beside the slots of bricks
    std::vector<double> values;  // of the surfaces
    bool operator==(const Wanted&) const = default;
  };
  RayRunPlan planOf(const ResolvedScene& scene);
  void light(const ResolvedScene& scene, const RenderSample& sample);
  static bool isWanted(const Wanted& wanted, float background, const Range& values);

  ResidentVolume& resident_;
  RenderOptions options_;
  VoxelCodes codes_;
  ResidentLight light_;
  RayRuns runs_;
  std::optional<Wanted> wanted_;
  std::optional<BrickSelection> bricks_;
  bool fits_ = false;          // all of them are resident at once
  std::uint64_t version_ = 0;  // of what parts of bricks hold
  IndexView view_;             // of the last picture
  ProjectionPass projection_;
  SurfacePass surfaces_;
  RenderStats stats_;
};

/// Returns how many slices rays are sampled on between two voxels.
int slicesPerVoxel(const ResolvedScene& scene, const Bricks& volume);

}  // namespace umbrick
