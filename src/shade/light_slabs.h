// What of a volume a sweep of light on OpenGL looks at: slabs of slices, blocks of voxels that get light there, and
// tiles of paths next to them. Nothing else is visited, so that the work follows the medium and not its box.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/light/light_paths.h"

namespace umbrick {

/// The visible bricks, and which of their blocks get light. Voxels count from the first one of the bricks' box.
struct LitBricks {
  BrickLayout layout;
  glm::i64vec3 first{0};           // the box's first voxel in index space
  glm::ivec3 extent{0};            // its voxels
  std::vector<glm::ivec3> places;  // first owned voxel of each brick
  std::vector<std::uint32_t> lit;  // by brick, then by block, x fastest: not 0 where there is medium
  glm::ivec3 blocks() const;       // of a brick along each axis
  std::size_t blocksPerBrick() const;
};

/// The slabs along one axis.
class LightSlabs {
 public:
  LightSlabs(int axis, const LitBricks& bricks);

  int axis() const { return axis_; }
  int count() const { return count_; }
  int slices() const;
  glm::ivec2 planeSize() const { return size_; }  // voxels of a slice
  int margin() const { return margin_; }          // voxels of a plane before the first one of the box
  /// Returns the slice of voxels that light of a sign comes to at this step of its way.
  int slice(int sign, int step) const;
  /// Returns a slab's number by its place on the way of the light.
  int slab(int sign, int place) const { return sign > 0 ? count_ - 1 - place : place; }

  /// The blocks with voxels on a slab, by slab: brick and number of the block.
  std::span<const glm::uvec2> blocks() const { return blocks_; }
  std::uint32_t firstBlock(int slab) const { return start_[static_cast<std::size_t>(slab)]; }
  std::uint32_t blockCount(int slab) const { return start_[static_cast<std::size_t>(slab) + 1] - firstBlock(slab); }

 private:
  friend class SidePaths;
  void add(const LitBricks& bricks, std::size_t brick, int block);
  int axis_, margin_, first_ = 0, count_ = 0;
  glm::ivec2 size_{0}, marksSize_{0};
  std::vector<std::uint8_t> marks_;  // by slab: squares of kLitBlock voxels of a plane in which blocks lie
  std::vector<glm::uvec2> blocks_;
  std::vector<std::uint32_t> start_;
};

/// The paths of some directions of one axis and sign through the slabs.
class SidePaths {
 public:
  /// @param first  the box's first voxel in index space
  SidePaths(const LightSlabs& slabs, const glm::i64vec3& first, std::span<const SweptDirection> directions);

  /// Returns a number of paths along each axis in which all have room at all slices.
  glm::ivec2 size() const { return size_; }
  /// Returns where path 0 of each direction is on each slice of the way, from the one before the first on: see Places
  /// in shaders/shade/light_carry.comp.
  std::span<const glm::vec4> places() const { return places_; }
  /// Returns the tiles of paths to be followed, by slab on the way of the light; see Tiles there.
  std::span<const std::uint32_t> tiles() const { return tiles_; }
  std::uint32_t firstTile(int place) const { return start_[static_cast<std::size_t>(place)]; }
  std::uint32_t tileCount(int place) const { return start_[static_cast<std::size_t>(place) + 1] - firstTile(place); }

  /// Makes the list of tiles, which takes a while. @pre planeSize() has at most kMostPathTiles tiles along each axis
  void findTiles(const LightSlabs& slabs, int sign);

 private:
  std::vector<std::uint32_t> tilesOf(const LightSlabs& slabs, int sign, int place) const;
  std::size_t directions_;
  glm::ivec2 size_{0};
  std::vector<glm::vec4> places_;
  std::vector<std::uint32_t> tiles_, start_;
};

}  // namespace umbrick
