// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/scalar_grid.h"

#include <cmath>

#include "umbrick/core/error.h"
#include "umbrick/core/transformed_box.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

bool ScalarGrid::isLevelSet() const { return grid->getGridClass() == openvdb::GRID_LEVEL_SET; }

std::string ScalarGrid::metadata(const std::string& key) const {
  const openvdb::Metadata::ConstPtr found = (*grid)[key];
  return found ? found->str() : std::string();
}

float ScalarGrid::emissionBackground() const {
  const float background = emission->background();
  return std::isfinite(background) ? background : 0.0f;
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
  if (box.empty()) return {};
  return transformed({glm::dvec3(box.min), glm::dvec3(box.max)}, indexToWorld());
}

}  // namespace umbrick
