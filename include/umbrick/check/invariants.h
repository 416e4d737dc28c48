// What must hold for bricks to change nothing, measured on a volume of the caller's.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/brick/brick_grid.h"
#include "umbrick/brick/bricks.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/gl/context.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// The invariants:
///   1  bricked equals unbricked, for every brick edge, pool size and number of textures
///   2  each pixel of each slice is shaded by exactly one brick
///   3  apron voxels equal the neighbour's voxels, interpolated values those of OpenVDB's BoxSampler
///   4  culling never changes a picture
///   5  the visibility V has no seam across brick faces, and none across skipped space
///   6  the order in which the bricks of a slice are drawn does not matter
///   7  what lies at the border of a volume is whole: empty space around it changes nothing, however wide the slabs
///   8  rays on OpenGL and techniques on the CPU make the picture that slices make, within twice the errors that both
///   state; rays on OpenGL and on the CPU agree in all other modes
struct InvariantResult {
  int invariant = 0;
  std::string name;       // what must hold, and for which model or bricks
  std::string measured;   // what `value` measures, with its unit
  double value = 0;       // in the view that is nearest to its limit, where several views were measured
  double limit = 0;       // the result has passed where value <= limit
  std::string limitFrom;  // where the limit comes from
  std::size_t samples = 0, excluded = 0;
  bool passed = false;
  bool complete = true;  // false: the check was stopped, and `passed` tells of what was measured until then
  std::string detail;    // where it was worst, what was left out and why
};

/// A camera to check with, in world units.
struct CheckView {
  std::string name;
  Camera camera;
  /// 0, or slices are an odd multiple of this apart, the one nearest to the scene's spacing: a view whose slices lie on
  /// faces keeps them there.
  double spacing = 0;
};

/// Returns views of a volume: face-on, diagonal and from inside under perspective; face-on and diagonal in parallel
/// view; and a parallel view in which slices lie exactly on voxel planes and brick faces, and pixel centres on brick
/// faces. The image size is that of the scene's camera. @throw InvalidArgument  the grid has no active voxel
std::vector<CheckView> checkViews(const ScalarGrid& grid, const ResolvedScene& resolved);

struct CheckOptions {
  /// What the pictures of the cone are made from, where that has another sampling than the scene has for emission; its
  /// volume, medium, camera, clipping and bricks are the scene's.
  std::optional<ResolvedScene> cone;
  std::vector<int> edges{8, 16, 32, 64};          // interiors to compare; those narrower than the apron are left out
  std::vector<CheckView> views;                   // empty: checkViews() and the scene's own camera
  int probedSlices = 24;                          // of each view, spread over the sweep
  std::size_t comparedBricks = 4000;              // most bricks whose aprons and ranges are read
  LightSweep lightSweep = LightSweep::automatic;  // of pictures by slices that are lit by a light volume
  unsigned seed = 1;                              // for what is chosen at random: bricks
  /// Called before each step and now and then within it. The check stops when it returns false.
  /// @param done  share of the work so far, in [0, 1]
  std::function<bool(const std::string& step, double done)> progress;
  /// Cuts the bricks that are checked; empty: brickGrid.
  std::function<std::unique_ptr<Bricks>(const ScalarGrid&, const BrickOptions&)> cut;
};

/// Measures all invariants. The scene gives medium, sampling, occlusion, clipping, brick edge, texel format and budget.
/// Emission and cone are rendered, the cone by the scene's method, without background radiance.
/// @param resolved  see resolveScene
/// @return all of them, in the order of their numbers, also when the check was stopped
/// @throw InvalidArgument  as SliceRenderer, checkViews and brickGrid
/// @throw GlError, IoError
/// @pre `context` is current
std::vector<InvariantResult> checkInvariants(const GlContext& context, const ScalarGrid& grid,
                                             const ResolvedScene& resolved, const CheckOptions& options = {});

}  // namespace umbrick
