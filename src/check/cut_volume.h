// A volume cut into bricks of several edges, which are compared, and the scenes that it is drawn for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/check/invariants.h"

namespace umbrick {

/// What is drawn by each model: the same but for its sampling.
struct CheckScenes {
  ResolvedScene emission, cone;
  const ResolvedScene& of(Model model) const { return model == Model::cone ? cone : emission; }
};

/// Returns the scenes without background radiance, since the same light must be behind pictures that are compared, and
/// with one edge of bricks. @throw InvalidArgument  as brickInterior
CheckScenes checkScenes(const ScalarGrid& grid, const ResolvedScene& emission,
                        const std::optional<ResolvedScene>& cone);

/// Returns the scene of a model as a view shows it.
ResolvedScene sceneOf(const CheckScenes& scenes, const CheckView& view, Model model);

struct CutVolume {
  const ScalarGrid& grid;
  int apron = 1;                                       // of all bricks; wide enough for all views and scenes
  std::map<int, std::unique_ptr<Bricks>> bricks = {};  // by edge
  int sceneEdge = 0;                                   // the scene's edge, or else the largest
  int pooledEdge = 0;                                  // of bricks that are so many that a pool of slots is put to use
};

/// Cuts the volume once per edge.
/// @throw InvalidArgument  slabs need an apron that is wider than every brick; the volume holds nothing; as brickGrid
CutVolume cutVolume(const ScalarGrid& grid, const CheckScenes& scenes, const std::vector<CheckView>& views,
                    const CheckOptions& options);

/// Returns how that volume is cut into bricks of an edge.
BrickOptions bricksOf(const CutVolume& volume, const ResolvedScene& scene, int edge);

}  // namespace umbrick
