// Cases of a kit for tests of renderers: small volumes on which renderers have been seen to fail, and how to look at
// them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// One picture of a case.
struct KitView {
  std::string name;     // is part of names of files
  ResolvedScene scene;  // mode integrate, model emission; without shading, clipping or a 2D transfer function
};

struct KitCase {
  std::string name;     // is the name of a folder
  std::string purpose;  // what goes wrong in renderers that fail, a sentence
  ScalarGrid grid;
  std::vector<KitView> views;
};

/// Returns the built-in cases, each of some 20^3 voxels, with bricks of 8^3: a slab whose picture is known in closed
/// form, a single voxel on the corner of eight bricks, tiles, a wall of one voxel, a sheared and mirrored transform, a
/// world and an index space far from the origin, a steep transfer function, an opaque medium, a background that is not
/// 0, an eye inside the medium, a thread of voxels through many bricks, and noise.
std::vector<KitCase> hardCases();

/// Returns a case of a volume of the caller's: the scene's own view, called "scene", and those of checkViews().
/// @param name  of a file: what is no letter or digit becomes a hyphen
/// @throw InvalidArgument  the scene has what a kit does not say to other renderers, such as clip planes: names the
///                         field; or as checkViews()
KitCase kitCaseOf(const std::string& name, const ScalarGrid& grid, const ResolvedScene& scene);

}  // namespace umbrick
