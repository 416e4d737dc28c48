// Renders bricks of a volume by proxy slices, nearest first: across the view, or across the volume's axes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/brick/bricks.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/gl/context.h"
#include "umbrick/shade/prepare.h"

namespace umbrick {

/// A slab is cut into segments along the view ray. Over a segment the value runs linearly, and the transfer function is
/// integrated stretch by stretch between its control points: opacity exactly, colour with what is behind dimmed by what
/// is in front (Engel, Kraus, Ertl 2001, doi:10.1145/383507.383515, without their table). So the picture depends
/// neither on where values lie nor on how far others lie apart, and no peak of the function is missed.
///
/// Slabs are drawn front to back, from O = 1, C = A = 0. For a slab with the mean medium (sigma_s, sigma_t), the length
/// d_e of the eye's path through it and the slice distance d:
///   alpha = 1 - exp(-sigma_t d_e)
///   C += (1 - A) (sigma_s / sigma_t) alpha O L_a        emission: O = 1
///   A += (1 - A) alpha
///   O  = exp(-sigma_t d) * mean of O over the cone's footprint on the slice before   (Algorithm 3; 2 as in the paper)
/// and in the end C + (1 - A) L_b. O is read straight before a point along the slice normal. These are the equations of
/// emission and of dos.
///
/// Ordinates have directions k of radiance L_k. The length of a path per depth is c_k for direction k, and r for the
/// path to the eye:
///   C += (1 - A) (sigma_s / sigma_t) (1 - exp(-tau (1 + a))) / (1 + a) L_a sum_k L_k T_k      tau = sigma_t d r
///   T_k = exp(-c_k tau_j / r) over all slabs j in front, along the path of k, met in whole texels of the lattice of
///         light
/// with a = c / r for the one c that would scatter the same from a solid slab:
///   sum_k L_k T_k / (1 + c_k) = sum_k L_k T_k / (1 + c)
/// Between texels, sums are interpolated with the transmittance along the view axis as their weight.
///
/// Scenes of the technique `stacks` have slices across the axes of the volume (slice/stack_slices.h), with emission or
/// a light volume. Where they lie on voxel slices alone (StackInterpolation::none), a slab has the medium of its slice,
/// whatever the quadrature.
/// Sources: Max 1995, doi:10.1109/2945.468400; Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x
class SliceRenderer : public Renderer {
 public:
  /// Culls, makes room in the volume's atlas and compiles what the scene needs. The first draw() uploads bricks.
  /// @param volume  must have the apron and the gradients that the scene needs; outlives this
  /// @throw InvalidArgument  the image is beyond the driver's limit, the apron too narrow or the budget too small
  /// @throw GlError
  /// @pre the context of `volume` is current
  SliceRenderer(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options = {});
  /// Makes a resident volume of its own. @param context,volume  outlive this
  /// @param limits  of the atlas; a format or a budget of 0 stands for the scene's
  SliceRenderer(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                const RenderOptions& options = {}, const AtlasLimits& limits = {});
  ~SliceRenderer() override;

  using Renderer::render;
  /// Renders the same scene from another camera. @throw InvalidArgument  slabs reach beyond the apron
  Picture render(const Camera& camera, const RenderSample& sample = {});

  /// Slices, so that what is halved is their distance, segments and windows; none where slabs reach beyond the apron.
  /// At hard edges of light in windows errors fall with an order of at least 0.45 for texels of 2 voxels or more, as
  /// measured. Interpolation between voxels blurs edges, so that it is at least 1 for texels of half a voxel.
  std::optional<RaySampling> sampling(const ResolvedScene& scene) const override;
  void draw(const RenderSample& sample = {}) override;
  Picture read() override;

  /// Cuts the slices of the scene and draws none of them: enough for probe() and sliceDepths(), where no picture is
  /// wanted.
  void cut();
  /// Returns what slice i of the last picture samples: channel 0 is the interpolated value, grid units, at the middle
  /// of the slab, channel 1 the number of bricks that shade the pixel.
  /// @throw InvalidArgument  there is no such slice
  Image probe(std::int64_t slice);
  /// Returns the depths of the slices of the last picture, world units.
  std::vector<double> sliceDepths() const;

 protected:
  void update(const ResolvedScene& next) override;

 private:
  class Implementation;
  std::unique_ptr<ResidentVolume> own_;  // the resident volume that this made for itself; null where it is shared
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace umbrick
