// Whether two grids place the same voxels at the same points of the world.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/math/Math.h>

#include <optional>
#include <sstream>
#include <string>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

struct Misplaced {
  openvdb::Coord voxel;
  openvdb::Vec3d expected, found;  // world space
};

/// Returns a vector as a text such as "(1 2 3)".
template <class Vector>
std::string vectorText(const Vector& v) {
  std::ostringstream out;
  out.precision(12);
  out << '(' << v[0] << ' ' << v[1] << ' ' << v[2] << ')';
  return out.str();
}

/// Returns the first corner of the box of `grid`'s active voxels that `other` places elsewhere, or nothing.
/// @param tolerance  largest distance that counts as the same place, in shortest edges of a voxel
inline std::optional<Misplaced> misplacedCorner(const openvdb::GridBase& grid, const openvdb::GridBase& other,
                                                double tolerance) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return std::nullopt;
  const openvdb::Vec3d size = grid.voxelSize();
  const double edge = size[static_cast<int>(openvdb::math::MinIndex(size))];
  for (int corner = 0; corner < 8; ++corner) {
    const openvdb::Coord at(corner & 1 ? box.max().x() : box.min().x(), corner & 2 ? box.max().y() : box.min().y(),
                            corner & 4 ? box.max().z() : box.min().z());
    const Misplaced place{at, grid.indexToWorld(at), other.indexToWorld(at)};
    if (!((place.expected - place.found).length() <= tolerance * edge)) return place;
  }
  return std::nullopt;
}

}  // namespace umbrick
