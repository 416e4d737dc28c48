// Renders bricks of a volume on the CPU, by rows of rays through rows of voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "umbrick/brick/bricks.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// How densely a shear-warped picture samples its volume.
struct ShearWarpSampling {
  int slicesPerVoxel = 1;   // samples of a ray between two slices of voxels
  double raysPerVoxel = 1;  // along its shortest edge, in the middle of the volume
  double raysPerPixel = 0;  // at least, there: where pixels are smaller than voxels the picture stays sharp
};

/// Returns the sampling that goes with a scene's distance of slices: so many slices and rays a voxel as a slab has
/// segments in it.
ShearWarpSampling shearWarpSampling(const ResolvedScene& scene, const Bricks& volume);

/// Tells whether shear-warp renders a scene: the models emission, cone and lights, the last two with light volumes.
bool shearWarpSupports(const SceneSettings& scene);

/// Shear-warp: along the main axis of the view, rays cross the slices of voxels in rows, so that voxels are read in the
/// order of memory. What the rays gather is a picture seen from the main axis, which is warped to the pixels.
///
/// Between two slices the value counts as linear, and the medium over it is integrated from a table, in parts where it
/// is thick. Rays have the exact value on each slice, and their true length in between; the picture is therefore off
/// by how the value bends between slices, and by what the warp loses between rays. Where a view is so wide that rays
/// lie flat in the slices of one axis, each pixel takes that axis which is its own ray's.
///
/// Renders the models emission, cone and lights, these two with light volumes. Bricks need an apron of one voxel.
/// Sources: Lacroute and Levoy 1994, doi:10.1145/192161.192283 (rows, spans, early termination); Engel, Kraus and Ertl
/// 2001, doi:10.1145/383507.383515 (integration over values that run linearly)
class ShearWarpRenderer : public Renderer {
 public:
  /// Reads the visible bricks into memory; where they exceed the scene's memory budget, each picture reads them band by
  /// band.
  /// @param volume    outlives this; with gradients where the transfer function asks for them
  /// @param sampling  none: shearWarpSampling() of each scene
  /// @throw InvalidArgument  a model or method that it does not know; a brick exceeds the memory budget
  ShearWarpRenderer(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options = {},
                    std::optional<ShearWarpSampling> sampling = {});
  ~ShearWarpRenderer() override;

  std::optional<RaySampling> sampling(const ResolvedScene& scene) const override;
  void draw(const RenderSample& sample = {}) override;
  Picture read() override;

 protected:
  void update(const ResolvedScene& next) override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace umbrick
