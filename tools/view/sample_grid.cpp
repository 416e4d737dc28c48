// SPDX-License-Identifier: Apache-2.0
#include "view/sample_grid.h"

#include <openvdb/tools/Interpolation.h>

#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "umbrick/grid/float_grid.h"

namespace umbrick::view {

std::optional<double> sampleAt(const ScalarGrid& grid, const glm::dvec3& world) {
  const glm::dvec3 index(glm::inverse(grid.indexToWorld()) * glm::dvec4(world, 1));
  const IndexBox box = grid.activeBox();
  for (int axis = 0; axis < 3; ++axis)
    if (!(index[axis] >= box.min[axis] - 1.0 && index[axis] <= box.max[axis] + 1.0)) return std::nullopt;
  auto accessor = grid.grid->getConstAccessor();
  return openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3d(index.x, index.y, index.z));
}

std::uint64_t activeVoxels(const ScalarGrid& grid) { return grid.grid->activeVoxelCount(); }

}  // namespace umbrick::view
