// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/dense_values.h"

#include <openvdb/tools/Dense.h>

#include <string>

#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

void copyValues(const ScalarGrid& grid, const IndexBox& box, std::span<float> out) {
  const glm::i64vec3 extent = box.extent();
  const auto voxels =
      static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y) * static_cast<std::size_t>(extent.z);
  if (voxels == 0 || voxels != out.size())
    throw InvalidArgument("box: expected one of " + std::to_string(out.size()) + " voxels, found one of " +
                          std::to_string(voxels));
  const openvdb::CoordBBox part({box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z});
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(part, out.data());
  openvdb::tools::copyToDense(*grid.grid, dense);
}

}  // namespace umbrick
