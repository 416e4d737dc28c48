// The coordinates in which rays walk through bricks, see shaders/shade/brick_walk.glsl.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "umbrick/core/box.h"
#include "umbrick/gl/program.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Cells of a lattice, which are bricks or parts of bricks: the first one, by its first owned voxel, and how many there
/// are along each axis.
struct CellBox {
  glm::i64vec3 first{0}, count{0};
  bool operator==(const CellBox&) const = default;
};

/// @param origins   first owned voxels of bricks, at least one
/// @param interior  owned voxels of a brick along each axis; parts: of each brick
CellBox cellsAround(std::span<const glm::ivec3> origins, const glm::ivec3& interior,
                    const glm::ivec3& parts = glm::ivec3(1));

/// Where the space of a brick begins, beside its first owned voxel: half a voxel before it, as slabs are cut, or at it,
/// where each cell of the bricks' lattice has the spaces between eight voxels that begin at the voxels it owns.
inline constexpr double kAroundVoxels = -0.5, kBetweenVoxels = 0;

/// Pixels [min, max).
struct PixelBox {
  glm::ivec2 min{0}, max{0};
};
/// Returns the pixels through which cells can be seen.
/// @param edge  voxels of a cell; corner: kAroundVoxels or kBetweenVoxels
PixelBox pixelsOf(const IndexView& view, const CellBox& cells, const glm::ivec3& edge, double corner);

/// Rays of one picture are cut into segments of equal depth, which are those of slabs: the middle of segment i from the
/// eye on is at depth (i + 1/2) depth + (phase - 1/2) spacing.
struct RayFrame {
  /// @param box       bricks; places are counted from the corner of the first one
  /// @param spacing   thickness of a slab; @param segments  of a slab; @param phase  see ProxySlices
  /// @param corner    kAroundVoxels or kBetweenVoxels
  /// @throw InvalidArgument  rays have too many segments to be counted in single precision
  RayFrame(const IndexView& view, const CellBox& box, const glm::ivec3& interior, double spacing, int segments,
           double phase, double corner = kAroundVoxels);

  /// Sets the uniforms of brick_walk.glsl but those of the table of slots.
  /// @param planes  that cut the medium, view coordinates
  /// @param medium  outside of which there is nothing to see, index coordinates
  void setUniforms(GlProgram& program, const IndexView& view, std::span<const glm::dvec4> planes,
                   const Box& medium) const;

  /// Sets those that say where the cells of a table of slots are. @param parts  cells of a brick along each axis
  void setCells(GlProgram& program, const CellBox& cells, const glm::ivec3& parts) const;

  CellBox bricks;
  glm::ivec3 interior;
  double corner;
  double depth = 0;        // of a segment, world units
  double firstDepth = 0;   // of the middle of segment 0, world units
  std::int64_t count = 0;  // of segments
};

}  // namespace umbrick
