// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/scalar_grid.h"

#include "umbrick/core/error.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

bool ScalarGrid::isLevelSet() const { return grid->getGridClass() == openvdb::GRID_LEVEL_SET; }

std::string ScalarGrid::metadata(const std::string& key) const {
  const openvdb::Metadata::ConstPtr found = (*grid)[key];
  return found ? found->str() : std::string();
}

glm::dmat4 ScalarGrid::indexToWorld() const {
  if (!grid->transform().isLinear())
    throw InvalidArgument("grid \"" + name + "\": expected an affine transform, found " + grid->transform().mapType());
  return affineMatrix(grid->transform());
}

IndexBox ScalarGrid::activeBox() const {
  openvdb::CoordBBox box;
  if (!grid->tree().evalActiveVoxelBoundingBox(box)) return {};
  return {{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}};
}

Box ScalarGrid::worldBounds() const {
  const IndexBox box = activeBox();
  Box bounds;
  if (box.empty()) return bounds;
  const glm::dmat4 matrix = indexToWorld();
  for (int corner = 0; corner < 8; ++corner)
    bounds.include(
        glm::dvec3(matrix * glm::dvec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                       corner & 4 ? box.max.z : box.min.z, 1)));
  return bounds;
}

}  // namespace umbrick
