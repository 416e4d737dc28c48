// Projections of values: the maximum, the minimum or the mean along the rays of a packet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sweep/brick_table.h"
#include "sweep/projection_kernels.h"
#include "sweep/value_ray.h"
#include "umbrick/core/box.h"

namespace umbrick {

/// What all packets of a picture share.
struct ProjectionFrame {
  const BrickVoxels* voxels = nullptr;
  const BrickTable* table = nullptr;
  IndexBox box;  // of the voxel centres that rays are taken through
  ProjectionKind kind = ProjectionKind::largest;
  int perVoxel = 1;      // slices
  bool skipping = true;  // false: bricks are taken that cannot change a ray, too
};

/// Takes packets of rays through the bricks. Samples lie where a ray crosses the voxels' own slices along the packet's
/// main axis, `perVoxel` to a voxel, and at both ends of its way. Since neither a maximum nor a mean asks for an order,
/// bricks come in that of their largest value, and those are never touched that lie below what all rays have.
class ProjectionMarch {
 public:
  using Rays = std::array<ValueRay, kRayGroup>;
  using Values = std::array<float, kRayGroup>;
  explicit ProjectionMarch(const ProjectionFrame& frame) : frame_(frame) {}

  /// @param rays    clipped to the box
  /// @param values  of each ray; the background where it meets nothing
  void march(const Rays& rays, Values& values);
  std::uint64_t samples() const { return samples_; }

 private:
  // A brick that the packet may meet.
  struct Met {
    float bound = 0;  // its largest value; of minima its smallest one
    std::int64_t layer = 0;
    std::array<std::int64_t, 3> cell{};
    const PlacedBrick* entry = nullptr;  // none: nothing but background
  };
  bool aim(const Rays& rays);
  void marchTogether(Values& values);
  void findBounds();
  void listBricks();
  void take(const Met& met, Values& values);
  const ProjectionPath& pathOf(std::int64_t layer);
  void addEnds(Values& values);
  bool beats(float low, float high, float threshold) const;
  float threshold(const Values& values) const;
  bool isMet(const PlacedBrick& entry, std::int64_t groupN, double from, double to, float threshold) const;

  ProjectionFrame frame_;
  int u_ = 0, v_ = 1, n_ = 2;
  std::array<bool, kRayGroup> valid_{};
  std::array<double, kRayGroup> u0_{}, v0_{}, slopeU_{}, slopeV_{};  // u = u0 + slope n
  std::array<double, kRayGroup> low_{}, high_{};                     // along n
  std::array<double, kRayGroup> first_{}, last_{};                   // slices in between, perVoxel to a voxel
  double least_ = 0, most_ = 0;                                      // of these
  // Bounds of the rays across, at least_ and at most_.
  std::array<std::array<double, 2>, 2> lowest_{}, highest_{};
  std::vector<Met> met_;
  std::int64_t pathLayer_ = 0, baseU_ = 0, baseV_ = 0;
  bool hasPath_ = false;
  ProjectionPath path_;
  std::uint64_t samples_ = 0;
};

}  // namespace umbrick
