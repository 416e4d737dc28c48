// A volume in memory: loaded once, then looked at by any number of scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <memory>
#include <string>

#include "umbrick/brick/bricks.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// A grid that holds something, with its place in the world.
class Volume {
 public:
  /// Reads a grid of a .vdb or .nvdb file.
  /// @throw IoError          as readScalarGrid
  /// @throw InvalidArgument  as readScalarGrid; the grid has no active voxel
  explicit Volume(const VolumeReference& file);
  /// Takes a grid.
  /// @param name  what messages call it
  /// @throw InvalidArgument  the transform is not affine; the grid has no active voxel
  Volume(ScalarGrid grid, std::string name);

  const std::string& name() const { return name_; }
  const ScalarGrid& grid() const { return grid_; }
  const glm::dmat4& indexToWorld() const { return indexToWorld_; }
  /// Returns the box around the active voxels' centres.
  const Box& worldBounds() const { return worldBounds_; }
  double loadMs() const { return loadMs_; }  // 0 where it was not read from a file

  /// Returns the scene with everything that depends on the volume written out, the edge of its bricks included.
  /// @throw InvalidArgument  as resolveScene and brickInterior
  ResolvedScene resolve(const Scene& scene) const;

  /// Cuts the bricks that a scene needs, see requiredBricks(). @throw InvalidArgument, IoError  as brickGrid
  std::unique_ptr<Bricks> cut(const ResolvedScene& scene) const;
  /// Cuts the bricks for a picture that is refined: with the apron of coarserScene() where bricks are large
  /// enough for it.
  std::unique_ptr<Bricks> cutForRefinement(const ResolvedScene& scene) const;

 private:
  ScalarGrid grid_;
  std::string name_;
  glm::dmat4 indexToWorld_{1};
  Box worldBounds_;
  double loadMs_ = 0;
};

/// Returns a transfer function for a volume of which nothing is known: grey, denser the farther a value is from the
/// background, on both sides of it, and transparent near it. The densest voxels let light through for a twentieth
/// of the diagonal.
TransferFunction greyRamp(const Volume& volume);

}  // namespace umbrick
