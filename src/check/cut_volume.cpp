// SPDX-License-Identifier: Apache-2.0
#include "check/cut_volume.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/shade/prepare.h"

namespace umbrick {

CheckScenes checkScenes(const ScalarGrid& grid, const ResolvedScene& emission,
                        const std::optional<ResolvedScene>& cone) {
  CheckScenes scenes{emission, cone.value_or(emission)};
  int interior = 0;
  for (ResolvedScene* scene : {&scenes.emission, &scenes.cone}) {
    scene->background.reset();
    scene->sampling.pixelSamples = 1;  // each sample of a pixel is a picture of its own, and one is enough
    interior = std::max(interior, brickInterior(*scene, grid.indexToWorld(), grid.worldBounds()));
  }
  for (ResolvedScene* scene : {&scenes.emission, &scenes.cone}) scene->bricks.interior = interior;
  return scenes;
}

ResolvedScene sceneOf(const CheckScenes& scenes, const CheckView& view, Model model) {
  ResolvedScene seen = scenes.of(model);
  seen.camera = view.camera;
  if (view.spacing > 0) {
    const double times = seen.sampling.spacing / view.spacing;
    seen.sampling.spacing = view.spacing * (2 * std::max(0.0, std::round((times - 1) / 2)) + 1);
  }
  seen.model = model;
  return seen;
}

CutVolume cutVolume(const ScalarGrid& grid, const CheckScenes& scenes, const std::vector<CheckView>& views,
                    const CheckOptions& options) {
  CutVolume volume{grid};
  for (const CheckView& view : views)
    for (const Model model : {Model::emission, Model::cone}) {
      ResolvedScene seen = sceneOf(scenes, view, model);
      seen.bricks.interior = kMostInterior;
      volume.apron = std::max(volume.apron, requiredApron(seen, grid.indexToWorld()));
    }
  const ResolvedScene& scene = scenes.emission;
  std::vector<int> edges = options.edges;
  edges.push_back(scene.bricks.interior);
  for (const int edge : edges) {
    if (edge < volume.apron || volume.bricks.contains(edge)) continue;
    const BrickOptions how = bricksOf(volume, scene, edge);
    volume.bricks[edge] = options.cut ? options.cut(grid, how) : brickGrid(grid, how);
  }
  if (volume.bricks.empty())
    throw InvalidArgument("check: slabs need an apron of " + std::to_string(volume.apron) +
                          " voxels, wider than every brick");
  if (volume.bricks.begin()->second->bricks.empty())
    throw InvalidArgument("check: the volume holds nothing but background");
  volume.sceneEdge =
      volume.bricks.contains(scene.bricks.interior) ? scene.bricks.interior : volume.bricks.rbegin()->first;
  // A pool and several textures make a difference only where there are some bricks.
  constexpr std::size_t kSomeBricks = 27;
  volume.pooledEdge = volume.bricks.at(volume.sceneEdge)->bricks.size() >= kSomeBricks ? volume.sceneEdge
                                                                                       : volume.bricks.begin()->first;
  return volume;
}

BrickOptions bricksOf(const CutVolume& volume, const ResolvedScene& scene, int edge) {
  BrickOptions options;
  options.interior = edge;
  options.apron = volume.apron;
  options.gradients = scene.transfer.is2d();
  options.gradientFilter = scene.gradients;
  return options;
}

}  // namespace umbrick
