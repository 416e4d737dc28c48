// Finds where rays cross surfaces of single values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sweep/brick_table.h"
#include "sweep/cell_cubic.h"
#include "sweep/value_ray.h"
#include "umbrick/core/box.h"
#include "umbrick/optics/gradient_filter.h"
#include "umbrick/scene/mode.h"

namespace umbrick {

/// A crossing of a ray and a surface.
struct SurfaceHit {
  double t = 0;             // along the ray
  std::size_t surface = 0;  // its number
  glm::dvec3 gradient{0};   // of the value, per voxel
  const VoxelBrick* brick = nullptr;
  glm::dvec3 at{0};  // in the brick, voxels from its first owned one
};

/// Takes rays through bricks, groups of cells and cells, and through no cell whose voxels do not lie on both sides of
/// a surface. In a cell the value along the ray is a cubic, all of whose crossings are found: no feature is lost,
/// however thin. A voxel is inside of a surface where its value is larger. Each thread has one.
class SurfaceRays {
 public:
  /// Bricks need an apron of kGradientApron. @param box  of the voxels between which there is a value that is not the
  /// background
  /// @param gradients  how those of hits are found
  SurfaceRays(const BrickVoxels& voxels, const BrickTable& table, const IndexBox& box,
              std::span<const SceneSurface> surfaces, GradientFilter gradients);

  /// Calls visit(hit) for the crossings of a ray, in order, until it returns false.
  void trace(const ValueRay& ray, const std::function<bool(const SurfaceHit&)>& visit);
  std::uint64_t cells() const { return cells_; }  // that were looked at

 private:
  enum class Side : std::int8_t { unknown, below, above };
  struct Place {
    const PlacedBrick* entry = nullptr;
    glm::ivec3 cell{0};        // in the brick
    std::ptrdiff_t index = 0;  // of the cell's first voxel
  };
  bool walkBrick(const PlacedBrick& entry, double enter, double leave);
  bool walkCell(const PlacedBrick& entry, const glm::ivec3& cell, double enter, double leave);
  CellCorners cornersAt(const VoxelBrick& brick, std::ptrdiff_t index) const;
  bool tell(const Place& place, double t, std::size_t surface);
  glm::dvec3 gradientAt(const Place& place, const glm::dvec3& point) const;
  glm::dvec3 splineGradientAt(const Place& place, const glm::dvec3& point) const;

  const BrickVoxels& voxels_;
  const BrickTable& table_;
  IndexBox box_;
  std::vector<double> values_;
  double lowest_ = 0, highest_ = 0;  // of them
  GradientFilter gradients_;
  std::ptrdiff_t strideY_ = 0, strideZ_ = 0;
  // Of the present ray:
  ValueRay ray_;
  glm::dvec3 inverse_{0};
  const std::function<bool(const SurfaceHit&)>* visit_ = nullptr;
  std::vector<Side> sides_;  // where the ray is, by surface
  double reached_ = 0;       // up to where they hold
  std::uint64_t cells_ = 0;
};

}  // namespace umbrick
