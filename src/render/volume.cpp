// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/volume.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/progressive.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick {

Volume::Volume(const VolumeReference& file) {
  const Stopwatch load;
  *this = Volume(readScalarGrid(file.file, file.grid), file.file.string());
  loadMs_ = load.elapsedMs();
}

Volume::Volume(ScalarGrid grid, std::string name) : grid_(std::move(grid)), name_(std::move(name)) {
  if (grid_.activeBox().empty()) throw InvalidArgument(name_ + ": grid \"" + grid_.name + "\" has no active voxel");
  indexToWorld_ = grid_.indexToWorld();
  worldBounds_ = grid_.worldBounds();
}

ResolvedScene Volume::resolve(const Scene& scene) const {
  ResolvedScene resolved = resolveScene(scene, worldBounds_, indexToWorld_);
  resolved.bricks.interior = brickInterior(resolved, indexToWorld_, worldBounds_);
  return resolved;
}

std::unique_ptr<Bricks> Volume::cut(const ResolvedScene& scene) const {
  const BrickOptions options = requiredBricks(scene, indexToWorld_, worldBounds_);
  return scene.bricks.bricked ? brickGrid(grid_, options) : unbrickedGrid(grid_, options);
}

std::unique_ptr<Bricks> Volume::cutForRefinement(const ResolvedScene& scene) const {
  const ResolvedScene coarser = coarserScene(scene);
  try {
    requiredApron(coarser, indexToWorld_);
  } catch (const InvalidArgument&) {
    return cut(scene);
  }
  return cut(coarser);
}

TransferFunction greyRamp(const Volume& volume) {
  const std::unique_ptr<Bricks> bricks = brickGrid(volume.grid());
  const double low = bricks->value.min, high = bricks->value.max, background = bricks->background;
  const double diagonal = glm::length(volume.worldBounds().extent());
  const double most = 20 / (diagonal > 0 ? diagonal : shortestVoxelEdge(volume.indexToWorld()));
  const double reach = std::max({high - background, background - low, 1e-30});
  const glm::dvec3 grey(0.8);
  const double margin = 0.1 * reach;
  std::vector<TransferFunction::Point> points;
  if (background - margin > low) points.push_back({low, {grey, most * (background - margin - low) / reach}});
  points.push_back({background - margin, {grey, 0}});
  points.push_back({background + margin, {grey, 0}});
  if (background + margin < high) points.push_back({high, {grey, most * (high - background - margin) / reach}});
  return TransferFunction(points);
}

}  // namespace umbrick
