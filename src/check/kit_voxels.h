// The voxels of a kit's volume one by one, and what interpolation makes of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// A voxel's value by its index.
using VoxelAt = std::function<double(const glm::i64vec3&)>;

/// Returns the trilinear interpolation in double precision. @param point  index coordinates, voxel centres at integers
inline double trilinear(const VoxelAt& voxel, const glm::dvec3& point) {
  const glm::dvec3 floor = glm::floor(point), share = point - floor;
  const glm::i64vec3 low(floor);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::i64vec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 weight = glm::mix(1.0 - share, share, glm::dvec3(offset));
    const double w = weight.x * weight.y * weight.z;
    if (w != 0) sum += w * voxel(low + offset);
  }
  return sum;
}

/// Returns a copy of what bricks say of a volume: a grid in which every voxel that differs from the background is
/// active and finite, and equal ones are tiles.
ScalarGrid cleanGrid(const Bricks& bricks);
/// Returns the voxels of one brick, apron included, all of them active, at their place.
ScalarGrid brickAsGrid(const Bricks& bricks, std::size_t brick);
/// Reads voxels of a grid. One thread may call what is returned at a time; the grid is kept.
VoxelAt voxelsOf(const ScalarGrid& grid);
/// Returns the voxels of a box, x fastest.
std::vector<float> denseVoxels(const ScalarGrid& grid, const IndexBox& box);

/// Which brick owns a point.
class BrickFinder {
 public:
  BrickFinder(const glm::ivec3& interior, const std::vector<glm::ivec3>& origins) : interior_(interior) {
    for (std::size_t i = 0; i < origins.size(); ++i)
      bricks_.emplace(std::array{origins[i].x, origins[i].y, origins[i].z}, static_cast<int>(i));
  }

  const glm::ivec3& interior() const { return interior_; }
  /// Returns the first voxel of the lattice cell around a point: the brick owns [origin - 1/2, origin + interior -
  /// 1/2).
  glm::dvec3 originAt(const glm::dvec3& point) const {
    return glm::floor((point + 0.5) / glm::dvec3(interior_)) * glm::dvec3(interior_);
  }
  /// Returns the brick's number, or -1 where there is none.
  int at(const glm::dvec3& point) const {
    const glm::dvec3 origin = originAt(point);
    const auto found =
        bricks_.find({static_cast<int>(origin.x), static_cast<int>(origin.y), static_cast<int>(origin.z)});
    return found == bricks_.end() ? -1 : found->second;
  }
  /// Tells whether interpolation at a point needs a voxel that its brick does not own.
  bool needsApron(const glm::dvec3& point) const {
    const glm::dvec3 first = glm::floor(point) - originAt(point);
    for (int axis = 0; axis < 3; ++axis) {
      const bool between = point[axis] != std::floor(point[axis]);
      if (first[axis] < 0 || (between && first[axis] + 1 >= interior_[axis])) return true;
    }
    return false;
  }

 private:
  glm::ivec3 interior_;
  std::map<std::array<int, 3>, int> bricks_;
};

}  // namespace umbrick
