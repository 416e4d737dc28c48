// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pictures/same_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "fuzz/pictures/dice.h"
#include "support/test_grids.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {
namespace {
using openvdb::Coord;
using openvdb::CoordBBox;

// The voxels at other indices: `place` takes a box to a box of as many voxels.
ScalarGrid withVoxelsAt(const ScalarGrid& grid, const glm::dmat4& indexToWorld,
                        const std::function<glm::ivec3(const glm::ivec3&)>& place) {
  const float background = grid.grid->background();
  openvdb::FloatGrid::Ptr moved = openvdb::FloatGrid::create(background);
  for (auto value = grid.grid->cbeginValueAll(); value; ++value) {
    if (!value.isValueOn() && *value == background) continue;
    CoordBBox box;
    value.getBoundingBox(box);
    const glm::ivec3 a = place({box.min().x(), box.min().y(), box.min().z()});
    const glm::ivec3 b = place({box.max().x(), box.max().y(), box.max().z()});
    const glm::ivec3 low = glm::min(a, b), high = glm::max(a, b);
    const CoordBBox to(Coord(low.x, low.y, low.z), Coord(high.x, high.y, high.z));
    if (value.isValueOn()) {
      moved->tree().denseFill(to, *value, true);
    } else {
      for (auto voxel = to.begin(); voxel; ++voxel) moved->tree().setValueOff(*voxel, *value);
    }
  }
  return withTransform(makeGrid(moved), indexToWorld);
}

ScalarGrid turned(const ScalarGrid& grid) {
  // New index (a, b, c) is old (y, -x, z).
  glm::dmat4 toWorld = grid.indexToWorld();
  const glm::dvec4 x = toWorld[0], y = toWorld[1];
  toWorld[0] = y;
  toWorld[1] = -x;
  return withVoxelsAt(grid, toWorld, [](const glm::ivec3& p) { return glm::ivec3(p.y, -p.x, p.z); });
}

ScalarGrid shifted(const ScalarGrid& grid, const glm::ivec3& shift) {
  return withVoxelsAt(grid, glm::translate(grid.indexToWorld(), -glm::dvec3(shift)),
                      [&](const glm::ivec3& p) { return p + shift; });
}

ScalarGrid padded(const ScalarGrid& grid, int margin) {
  openvdb::FloatGrid::Ptr copy = grid.grid->deepCopy();
  CoordBBox box = copy->evalActiveVoxelBoundingBox();
  box.expand(margin);
  openvdb::FloatGrid::Ptr border = openvdb::FloatGrid::create(copy->background());
  border->denseFill(box, copy->background(), true);
  copy->tree().topologyUnion(border->tree());
  ScalarGrid result = grid;
  result.grid = copy;
  return result;
}

TransferFunction steeper(const TransferFunction& transfer, double factor) {
  if (!transfer.is2d()) return transfer.scaled(factor);
  std::vector<double> gradients = transfer.gradients();
  for (double& gradient : gradients) gradient *= factor;
  return TransferFunction(transfer.values(), gradients, transfer.media()).scaled(factor);
}

// Every point p of the world goes to scale p + offset.
SameScene elsewhere(std::string name, const ScalarGrid& grid, const ResolvedScene& scene, double scale,
                    const glm::dvec3& offset) {
  const auto to = [&](const glm::dvec3& p) { return scale * p + offset; };
  SameScene result{std::move(name), {}, scene};
  glm::dmat4 toWorld = grid.indexToWorld();
  for (glm::length_t axis = 0; axis < 3; ++axis) toWorld[axis] *= scale;
  toWorld[3] = glm::dvec4(to(glm::dvec3(toWorld[3])), 1);
  result.grid = withTransform(grid, toWorld);
  ResolvedScene& changed = result.scene;
  changed.transfer = steeper(scene.transfer, 1 / scale);
  Camera& camera = changed.camera;
  camera.eye = to(camera.eye);
  camera.lookAt = to(camera.lookAt);
  camera.viewHeight *= scale;
  camera.nearDistance *= scale;
  changed.sampling.spacing *= scale;
  for (ClipPlane& plane : changed.clipPlanes) plane.w = scale * plane.w - glm::dot(glm::dvec3(plane), offset);
  if (changed.clipBox) changed.clipBox = Box{to(changed.clipBox->min), to(changed.clipBox->max)};
  return result;
}

bool backgroundIsClear(const ScalarGrid& grid, const TransferFunction& transfer) {
  const float background = grid.grid->background();
  return transfer(std::isfinite(background) ? background : 0).sigma_t == 0;
}

}  // namespace

std::vector<SameScene> sameScenes(const ScalarGrid& grid, const ResolvedScene& scene, int apron, std::uint64_t seed) {
  Dice dice(seed, 77);
  std::vector<SameScene> same;
  const auto withBricks = [&](const char* name, const auto& change) {
    same.push_back({name, grid, scene});
    change(same.back().scene.bricks);
  };
  const int widest = 8 * ((apron + 7) / 8);
  withBricks("unbricked", [](BrickSettings& bricks) { bricks.bricked = false; });
  withBricks("edge", [&](BrickSettings& bricks) {
    const int before = bricks.interior;
    do {
      bricks.interior = std::max(widest, dice.of({8, 16, 24, 32, 40, 64}));
    } while (bricks.interior == before && widest < 64);
  });
  withBricks("not culled", [](BrickSettings& bricks) { bricks.culling = !bricks.culling; });
  withBricks("float32", [](BrickSettings& bricks) { bricks.format = "float32"; });
  same.push_back({"turned", turned(grid), scene});
  const auto odd = [&] { return 2 * dice.whole(-30, 30) + 1; };
  const int x = odd(), y = odd(), z = odd();
  same.push_back({"shifted", shifted(grid, {x, y, z}), scene});
  if (backgroundIsClear(grid, scene.transfer)) same.push_back({"padded", padded(grid, dice.whole(2, 9)), scene});
  const double edge = shortestVoxelEdge(grid.indexToWorld());
  same.push_back(elsewhere("scaled", grid, scene, dice.scaleBetween(1e-3, 1e3) / edge, glm::dvec3(0)));
  same.push_back(elsewhere("moved", grid, scene, 1, edge * dice.scaleBetween(1, 1000) * dice.direction()));
  return same;
}

}  // namespace umbrick
