// Renders bricks of a volume on the CPU, by a ray through each pixel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "umbrick/brick/bricks.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Tells whether rays render a scene: the models emission, cone and lights, the last two with light volumes.
bool raysSupport(const SceneSettings& scene);

/// Returns how many samples a ray takes between two slices of voxels for a scene: so many as a slab has segments in it.
int raySamplesPerVoxel(const ResolvedScene& scene, const Bricks& volume);

/// Rays through the pixels, sampled where they cross the voxels' own slices, along the axis that each packet of 4 x 4
/// rays follows most: there values are interpolated between four voxels. In between, the value counts as linear, and
/// the medium over it is integrated from a table, as shear-warp does; there is no warp, so that all that is left is how
/// the value bends between slices. Layers of bricks and of groups of cells that show nothing are skipped, and rays
/// that are full end.
///
/// Renders the models emission, cone and lights, these two with light volumes. Bricks need an apron of one voxel.
/// Sources: Wald et al. 2001, doi:10.1111/1467-8659.00508 (packets); Engel, Kraus and Ertl 2001,
/// doi:10.1145/383507.383515 (integration over values that run linearly)
class RayRenderer : public Renderer {
 public:
  /// Reads the visible bricks into memory; where they exceed the scene's memory budget, each picture reads them band by
  /// band.
  /// @param volume    outlives this; with gradients where the transfer function asks for them
  /// @param perVoxel  samples between two slices of voxels; none: raySamplesPerVoxel() of each scene
  /// @throw InvalidArgument  a model or method that it does not know; a brick exceeds the memory budget
  RayRenderer(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options = {},
              std::optional<int> perVoxel = {});
  ~RayRenderer() override;

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
