// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/volume.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <mutex>
#include <utility>
#include <vector>

#include "render/volume_file.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/core/transformed_box.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/render/suggest_transfer.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/sweep/swept_bricks.h"

namespace umbrick {
namespace {

// The second grid by itself. @pre there is one, or nothing is asked of it but its box
ScalarGrid emissionOf(const ScalarGrid& grid) {
  ScalarGrid second;
  second.grid = grid.emission ? grid.emission : grid.grid;
  return second;
}

}  // namespace

struct Volume::LazyGradient {
  std::once_flag looked;
  double largest = 0;
};

Volume::Volume(const VolumeReference& file, const std::function<void(double share)>& progress,
               const std::shared_ptr<KeptStream>& kept) {
  const Stopwatch load;
  *this = Volume(readVolumeFile(file, progress, kept), file.file.string());
  loadMs_ = load.elapsedMs();
}

Volume::Volume(const std::string& name, const OpenOptions& open, const std::function<void(double share)>& progress) {
  const Stopwatch load;
  *this = Volume(readVolumeArray(name, open, progress), name);
  loadMs_ = load.elapsedMs();
}

Volume::Volume(VolumeFile&& read, std::string name) : Volume(std::move(read.grid), std::move(name), read.foreign) {
  orientation_ = orientationOf(grid_, foreign_, read.creator);
  notes_ = std::move(read.notes);
  source_ = std::move(read.source);
}

Volume::Volume(ScalarGrid grid, std::string name, bool foreign)
    : grid_(std::move(grid)), name_(std::move(name)), largestGradient_(std::make_shared<LazyGradient>()) {
  if (grid_.activeBox().empty()) throw EmptyVolume(name_ + ": grid \"" + grid_.name + "\" has no active voxel");
  indexToWorld_ = grid_.indexToWorld();
  worldBounds_ = grid_.worldBounds();
  if (const Box second = emissionOf(grid_).worldBounds(); grid_.emission && !emissionOf(grid_).activeBox().empty())
    worldBounds_ = {glm::min(worldBounds_.min, second.min), glm::max(worldBounds_.max, second.max)};
  foreign_ = foreign && grid_.metadata("source_format").empty();
  orientation_ = orientationOf(grid_, foreign_);
  valueUnit_ = grid_.metadata("value_unit");
}

Box Volume::visibleBounds(const TransferFunction& transfer) const {
  const double diagonal = std::max(glm::length(worldBounds_.extent()), shortestVoxelEdge(indexToWorld_));
  constexpr double kLeastDepth = 0.01;
  const double least = kLeastDepth / diagonal;
  const Range gradients = transfer.is2d() ? transfer.gradientDomain() : Range{0, 0};
  const IndexBox visible = acceptedBox(grid_, [&](double value) {
    const auto single = static_cast<float>(value);
    return transfer.majorant({single, single}, gradients) > least;
  });
  IndexBox box = visible.empty() ? grid_.activeBox() : visible;
  if (grid_.emission) {
    const ScalarGrid second = emissionOf(grid_);
    const double largest = surveyValues(second).value.max;
    const IndexBox glowing = acceptedBox(second, [&](double value) { return value > 0 && value > 0.2 * largest; });
    if (!glowing.empty())
      box = visible.empty() ? glowing : IndexBox{glm::min(box.min, glowing.min), glm::max(box.max, glowing.max)};
  }
  // A voxel reaches half way to its neighbours.
  const glm::dvec3 low = glm::dvec3(box.min) - 0.5, high = glm::dvec3(box.max) + 0.5;
  return transformed({low, high}, indexToWorld_);
}

double Volume::largestGradient() const {
  std::call_once(largestGradient_->looked, [&] { largestGradient_->largest = umbrick::largestGradient(grid_); });
  return largestGradient_->largest;
}

TransferFunction inUnit(const TransferFunction& transfer, std::string_view unit) {
  if (transfer.unit() == kShiftedHounsfield && unit == kHounsfield)
    return transfer.shifted(-1000).withUnit(std::string(unit));
  if (transfer.unit() == kHounsfield && unit == kShiftedHounsfield)
    return transfer.shifted(1000).withUnit(std::string(unit));
  return transfer;
}

ResolvedScene Volume::resolve(const Scene& scene) const {
  Scene complete = scene;
  complete.transfer = scene.transfer ? fitted(*scene.transfer, *this) : suggestTransfer(*this).transfer;
  return resolve(complete, scene.orbit ? visibleBounds(*complete.transfer) : worldBounds_);
}

ResolvedScene Volume::resolve(const Scene& scene, const Box& seen) const {
  Scene complete = scene;
  if (!scene.transfer) complete.transfer = suggestTransfer(*this).transfer;
  if (traitsOf(scene.mode).surfaces && scene.surfaces.empty()) {
    if (!grid_.isLevelSet())
      throw InvalidArgument("surfaces: is empty, must be one value or more for the mode " + modeName(scene.mode) +
                            " of what is no level set");
    complete.surfaces = {SceneSurface{}};
  }
  if (scene.orbit) complete.orbit = settledOrbit(*scene.orbit, orientation_);
  if (scene.gradientUnit == GradientUnit::percent && scene.gradientOpacity != glm::dvec2(0)) {
    if (!(largestGradient() > 0))
      throw InvalidArgument("gradientUnit: percent of the largest gradient, which is 0 in this volume");
    complete.gradientOpacity *= largestGradient() / 100;
    complete.gradientUnit = GradientUnit::grid;
  }
  ResolvedScene resolved = resolveScene(complete, seen, indexToWorld_);
  resolved.bricks.interior = brickInterior(resolved, indexToWorld_, worldBounds_);
  return resolved;
}

std::unique_ptr<Bricks> Volume::cut(const ResolvedScene& scene) const {
  return cutGrid(grid_, requiredBricks(scene, indexToWorld_, worldBounds_), scene.bricks.bricked);
}

std::unique_ptr<Bricks> Volume::cutForCpu(const ResolvedScene& scene) const {
  return cutGrid(grid_, sweptBricks(scene), scene.bricks.bricked);
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

}  // namespace umbrick
