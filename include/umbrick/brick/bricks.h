// A sparse volume cut into bricks of equal size, each with an apron of its neighbours' voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "umbrick/core/box.h"
#include "umbrick/core/range.h"

namespace umbrick {

/// The smallest texel that holds every voxel exactly.
enum class VoxelFormat {
  unorm8,   // whole numbers that span at most 255
  unorm16,  // whole numbers that span at most 65535
  half,
  float32,
};

/// Owned voxels along a brick's edge unless something asks for others: small enough to skip most of what is empty, and
/// large enough that aprons are no more than a quarter of it.
inline constexpr int kDefaultInterior = 24;

/// How a volume is cut.
struct BrickOptions {
  int interior = kDefaultInterior;  // owned voxels along each edge, 8 to 256, a multiple of 8 (whole leaves)
  int apron = 1;                    // ghost voxels; a sample may lie up to apron - 1/2 voxels outside the brick
  bool gradients = false;           // for 2D transfer functions
};

/// The brick at lattice cell c owns voxels [origin, origin + interior) and the space [origin - 1/2, origin + interior -
/// 1/2) of continuous index space (voxel centres at integers), origin = c * interior.
struct BrickLayout {
  glm::ivec3 interior{kDefaultInterior};  // owned voxels along each axis
  int apron = 1;                          // ghost voxels on each side
  glm::ivec3 edge() const { return interior + 2 * apron; }
  std::size_t voxels() const {
    const glm::ivec3 e = edge();
    return static_cast<std::size_t>(e.x) * static_cast<std::size_t>(e.y) * static_cast<std::size_t>(e.z);
  }
};

struct Brick {
  glm::ivec3 origin;  // index space, first owned voxel
  Range value;        // grid units, over interior and apron
  Range gradient;  // gradient magnitude, grid units per world unit, over interior and apron; {0, 0} when not asked for
  bool uniform() const { return value.min == value.max; }
};

/// The bricks of one volume. What holds the voxels is behind read(), so that no GL room sees OpenVDB.
class Bricks {
 public:
  virtual ~Bricks() = default;

  BrickLayout layout;
  glm::dmat4 indexToWorld{1};  // affine
  // Active voxels, and others that differ from the background, grown by one.
  IndexBox domain;
  Range value;     // over all voxels, the background included
  Range gradient;  // {0, 0} without gradients
  float background = 0;
  // A value near which most voxels lie that are not background, where they lie together far from 0 (pressures around
  // 101 325, say); else 0. Single precision has more digits for distances from it than for the values themselves.
  float anchor = 0;
  bool hasGradients = false;
  VoxelFormat exactFormat = VoxelFormat::float32;
  std::uint64_t nonFiniteVoxels = 0;  // active NaN or infinite voxels, read as background
  // The cells that hold anything but background in interior or apron, or a gradient; ascending in z, then y, then x.
  // Those beyond the domain are among them whose aprons reach into it: slabs with their middle there may do so, too.
  std::vector<Brick> bricks;

  /// How far beyond its faces a brick sees voxels: the apron, and one more with gradients.
  int margin() const { return layout.apron + (hasGradients ? 1 : 0); }
  /// The box from which a slab or a gradient may reach into the domain: the domain grown by the margin.
  IndexBox reach() const;

  /// Voxels of the cell whose first owned voxel is `origin` (any lattice cell, also one not in `bricks`), x fastest,
  /// edge() voxels along each axis beginning at origin - apron. Safe to call from several threads.
  /// @param gradients  empty, or the gradient magnitude of each voxel: central differences of neighbouring voxels, in
  ///                   grid units per world unit
  /// @throw InvalidArgument  a span of the wrong size, or gradients without hasGradients
  virtual void read(const glm::ivec3& origin, std::span<float> values, std::span<float> gradients = {}) const = 0;
};

/// Cells of the lattice that meet reach() and are not in `bricks`: what must be drawn when the background is visible.
/// @throw InvalidArgument  more than `limit`: says how many and names the background value
std::vector<Brick> backgroundBricks(const Bricks& bricks, std::size_t limit = 1u << 20);

}  // namespace umbrick
