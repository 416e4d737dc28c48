// Pictures of values by rays: projections and isosurfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "sweep/brick_table.h"
#include "sweep/brick_voxels.h"
#include "sweep/projection_march.h"
#include "sweep/surface_light.h"
#include "umbrick/draw/hybrid_picture.h"

namespace umbrick {

/// Renders the modes that look at values and not at a medium, mip, minip, average and isosurface, and the surfaces of
/// hybrid.
class ValueRays {
 public:
  /// @param volume    outlives this
  ValueRays(const Bricks& volume, const RenderOptions& options);

  /// Takes another scene and holds the bricks that it needs.
  /// @throw InvalidArgument  surfaces of values that the volume does not have; no light to reflect; the bricks are more
  ///   than the scene's memory budget
  void update(const ResolvedScene& next);
  /// @param perVoxel  slices of a projection between two slices of voxels
  /// @param ends      depths at which rays end, world units; null: nowhere
  Picture draw(const ResolvedScene& scene, const RenderSample& sample, int perVoxel, const Image* ends);
  /// Draws the first surface of each ray, of a scene of the mode hybrid.
  FirstSurfaces drawFirst(const ResolvedScene& scene, const RenderSample& sample, const Image* ends);

 private:
  void drawProjection(const ResolvedScene& scene, int perVoxel, const Image* ends, Picture& picture);
  Picture begin(const ResolvedScene& scene, const RenderSample& sample);
  /// @param start  null: all surfaces of a ray are drawn; else the first one, with where the medium behind it begins
  void drawSurfaces(const ResolvedScene& scene, const Image* ends, Picture& picture, Image* start);
  void eachRow(int rows, const std::function<void(int)>& draw) const;

  RenderOptions options_;
  BrickVoxels voxels_;
  std::optional<BrickTable> table_;
  std::optional<SurfaceLight> light_;  // of surfaces; none: there was no such scene yet
  // What the bricks that are held were selected for.
  bool selected_ = false, all_ = false;
  std::vector<double> values_;
  std::uint64_t budgetMiB_ = 0;
  bool culling_ = true;
  double loadMs_ = 0;
  std::uint64_t loaded_ = 0;
  IndexView view_;
  std::vector<glm::dvec4> planes_;
};

}  // namespace umbrick
