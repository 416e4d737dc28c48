// SPDX-License-Identifier: Apache-2.0
#include "grid/empty_grid.h"

#include <cmath>
#include <memory>
#include <sstream>

#include "umbrick/core/error.h"
#include "umbrick/grid/affine_matrix.h"

namespace umbrick {
namespace {

openvdb::math::Transform::Ptr makeTransform(const std::string& name, const glm::dmat4& indexToWorld) {
  using namespace openvdb::math;
  const glm::dmat4& m = indexToWorld;
  const Mat4d map = rowMatrix(m);
  bool diagonal = true;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 3; ++i) diagonal = diagonal && (axis == i || m[axis][i] == 0);
  // A grid that needs no more than scale and translation gets a map of just these, so that programs which know no other
  // map can place it.
  const Vec3d scale(m[0][0], m[1][1], m[2][2]), origin(m[3][0], m[3][1], m[3][2]);
  try {
    MapBase::Ptr base;
    if (diagonal && scale[0] == scale[1] && scale[1] == scale[2])
      base = std::make_shared<UniformScaleTranslateMap>(scale[0], origin);
    else if (diagonal)
      base = std::make_shared<ScaleTranslateMap>(scale, origin);
    else
      base = std::make_shared<AffineMap>(map);
    return std::make_shared<Transform>(base);
  } catch (const openvdb::Exception&) {
    std::ostringstream text;
    text << name << ": spacing: expected voxels of at least 3e-15 cubed world units (OpenVDB allows no less), found "
         << std::abs(map.getMat3().det()) << "; use a smaller unit of length";
    throw InvalidArgument(text.str());
  }
}

}  // namespace

void placeVolumeGrid(const VolumeInfo& info, const std::string& name, openvdb::GridBase& grid) {
  for (const auto& [key, value] : info.metadata)
    if (!key.empty()) grid.insertMeta(key, openvdb::StringMetadata(value));
  grid.setName(name);
  grid.setGridClass(openvdb::GRID_FOG_VOLUME);
  grid.setTransform(makeTransform(info.name, info.indexToWorld));
}

}  // namespace umbrick
