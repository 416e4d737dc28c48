// SPDX-License-Identifier: Apache-2.0
#include "check/kit_grids.h"

#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "check/kit_voxels.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

constexpr double kMostRearranged = 1 << 24, kMostMagnified = 1 << 17;  // voxels

ScalarGrid gridFrom(const IndexBox& box, float background, const glm::dmat4& indexToWorld,
                    const std::function<float(const glm::ivec3& offset)>& value) {
  const auto grid = openvdb::FloatGrid::create(background);
  auto voxels = grid->getAccessor();
  for (int z = box.min.z; z <= box.max.z; ++z)
    for (int y = box.min.y; y <= box.max.y; ++y)
      for (int x = box.min.x; x <= box.max.x; ++x) {
        const float v = value(glm::ivec3(x, y, z) - box.min);
        if (v != background) voxels.setValue(openvdb::Coord(x, y, z), v);
      }
  grid->setTransform(openvdb::math::Transform::createLinearTransform(rowMatrix(indexToWorld)));
  ScalarGrid result;
  result.grid = grid;
  return result;
}

}  // namespace

std::vector<MisreadGrid> misreadGrids(const ScalarGrid& grid, const IndexBox& box) {
  const glm::i64vec3 extent = box.extent();
  const double count = static_cast<double>(extent.x) * static_cast<double>(extent.y) * static_cast<double>(extent.z);
  if (count > kMostRearranged) return {};
  const std::vector<float> dense = denseVoxels(grid, box);
  const glm::ivec3 dims(extent);
  const float background = grid.grid->background();
  const glm::dmat4 toWorld = grid.indexToWorld();
  const auto at = [&](const glm::ivec3& p) {
    return dense[static_cast<std::size_t>((static_cast<std::int64_t>(p.z) * dims.y + p.y) * dims.x + p.x)];
  };
  std::vector<MisreadGrid> list;
  const auto rearrange = [&](const std::string& sentence, const std::function<float(const glm::ivec3&)>& value) {
    list.push_back({gridFrom(box, background, toWorld, value), sentence});
  };
  rearrange("volume.raw is read with z fastest: x is fastest in it", [&](const glm::ivec3& p) {
    return dense[static_cast<std::size_t>((static_cast<std::int64_t>(p.x) * dims.y + p.y) * dims.z + p.z)];
  });
  for (int axis = 0; axis < 3; ++axis)
    rearrange(std::string("voxels are mirrored along ") + "ijk"[axis], [&](glm::ivec3 p) {
      p[axis] = dims[axis] - 1 - p[axis];
      return at(p);
    });
  for (const double half : {0.5, -0.5}) {
    ScalarGrid moved = gridFrom(box, background, glm::translate(toWorld, glm::dvec3(half)), at);
    list.push_back({moved, "the volume is moved by half a voxel " + std::string(half > 0 ? "up" : "down") +
                               " each axis: voxel centres lie at whole index coordinates"});
  }
  if (background != 0) {
    // Without the outermost layer, which is background.
    const IndexBox inner{box.min + 1, box.max - 1};
    list.push_back({gridFrom(inner, 0, toWorld, [&](const glm::ivec3& p) { return at(p + 1); }),
                    "0 is taken for what lies around the volume: it is the background"});
  }
  if (count <= kMostMagnified) {
    // Each voxel as a cube of 4^3, with sharp edges but for a quarter of a voxel.
    constexpr int kTimes = 4;
    const IndexBox large{glm::ivec3(0), dims * kTimes - 1};
    const glm::dmat4 place = glm::translate(toWorld, glm::dvec3(box.min) - 0.5 + 0.5 / kTimes);
    list.push_back({gridFrom(large, background, glm::scale(place, glm::dvec3(1.0 / kTimes)),
                             [&](const glm::ivec3& p) { return at(p / kTimes); }),
                    "values are not interpolated: each point has that of the nearest voxel"});
  }
  return list;
}

}  // namespace umbrick
