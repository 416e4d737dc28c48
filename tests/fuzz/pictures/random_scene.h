// Random volumes and scenes for pictures that must agree with the reference. The same seed makes the same scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// What is rendered: emission and absorption alone; one cone of light around the view axis, by either method; light
/// sources; or any of these, emission in half of the scenes.
enum class SceneKind { emission, occlusion, lights, any };
/// "emission", "occlusion", "lights" or "any". @throw InvalidArgument  another name
SceneKind parseSceneKind(std::string_view name);

struct RandomScene {
  ScalarGrid grid;
  ResolvedScene scene;      // its brick edge may be 0, which asks for brickInterior
  std::string description;  // one line: what kinds of grid, function, camera, ... were drawn
};

/// A grid of at most about 48 voxels of content along an axis (two bodies may lie further apart, and a tile be larger),
/// and a scene that shows it in a picture of at most `largest` pixels along an edge. One kind of each is drawn:
///   grid      blobs, shells, sheets of one to three voxels that end at every residue of the brick edge, single voxels,
///             tiles, labels, level sets, a field cut off by the faces of its box, noise, two bodies far apart
///   values    offset and scaled, whole numbers, one outlier, voxels that are not finite, a border of active background
///   place     negative indices, indices up to a million, tiny and huge voxels, rotated, sheared, mirrored, far away
///   function  ramps, steps, peaks down to 1/2000 of the range, bands, solids, pieces, by value and gradient, with or
///             without a visible background
///   view      parallel and perspective, along the axes of the grid, from inside, through a near plane, wide
///   the rest  clip planes and boxes, slices 1/4 to 6 voxels apart in 1 to 8 segments, both quadratures, both bits,
///   size
///             of tables, edges of bricks
/// Extinction is chosen for the content's thickness, so that most pictures are neither empty nor solid.
RandomScene randomScene(std::uint64_t seed, SceneKind kind, int largest = 48);

}  // namespace umbrick
