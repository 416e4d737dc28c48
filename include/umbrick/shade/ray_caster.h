// Renders bricks of a volume on OpenGL, by a ray through each pixel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/gl/context.h"
#include "umbrick/shade/prepare.h"

namespace umbrick {

/// Rays through the pixels, marched through the bricks that are resident in one draw, segment by segment. Segments are
/// those of slabs: they lie at the same depths as the slices of a SliceRenderer and are integrated with the same
/// functions, so that both make the same picture but for rounding, for where a ray ends (SamplingOptions::saturation)
/// and for slabs that a clip plane cuts into segments. Values at the end of a segment serve the next one, too.
///
/// The way from brick to brick goes through a table of the cells of their lattice, which says where a cell's brick is
/// in the atlas or how far there is none. Where bricks do not fit the atlas together, they are drawn in runs, nearest
/// first. Sums are kept in 32 bits, whatever SamplingOptions::bits says.
///
/// Renders the models emission, cone, ambient and lights, the last three with light volumes or, where all visible
/// bricks are drawn at once, cone rays, and all modes. Projections are sampled on the voxels' own slices, and surfaces
/// are found cell by cell, as by RayRenderer on the CPU; bricks then need an apron of one voxel, and of two for
/// surfaces and for light that is reflected. Sources: Krüger and Westermann 2003, doi:10.1109/VISUAL.2003.1250384 (rays
/// on graphics hardware); Amanatides and Woo 1987, doi:10.2312/egtp.19871000 (the walk through cells); Cohen and
/// Sheffer 1994, doi:10.1007/BF01900697 (distances to what is next)
class RayCaster : public Renderer {
 public:
  /// @param volume  must have the apron and the gradients that the scene needs; outlives this
  /// @throw InvalidArgument  a model or method that it does not know; the image is beyond the driver's limit, the apron
  ///   too narrow or the budget too small
  /// @throw GlError
  /// @pre the context of `volume` is current
  RayCaster(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options = {});
  /// Makes a resident volume of its own. @param context,volume  outlive this
  /// @param limits  of the atlas; a format or a budget of 0 stands for the scene's
  RayCaster(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
            const RenderOptions& options = {}, const AtlasLimits& limits = {});
  ~RayCaster() override;

  std::optional<RaySampling> sampling(const ResolvedScene& scene) const override;
  void draw(const RenderSample& sample = {}) override;
  Picture read() override;

 protected:
  void update(const ResolvedScene& next) override;

 private:
  class Implementation;
  std::unique_ptr<ResidentVolume> own_;  // the resident volume that this made for itself; null where it is shared
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace umbrick
