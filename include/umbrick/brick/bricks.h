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
#include "umbrick/optics/gradient_filter.h"

namespace umbrick {

/// The smallest format of a texel that holds every voxel exactly.
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
  GradientFilter gradientFilter = GradientFilter::central;  // by which they are found
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
  glm::ivec3 origin;  // first owned voxel in index space
  Range value;        // grid units, over interior and apron
  /// Gradient magnitude over interior and apron, grid units per world unit; {0, 0} when it is not asked for.
  Range gradient;
  Range emission{0, 0};  // as `value`, of the second grid; {0, 0} where there is none
  bool uniform() const { return value.min == value.max; }
};

/// The bricks of one volume. Whatever holds the voxels is hidden behind read(), so that no GL room sees OpenVDB.
class Bricks {
 public:
  virtual ~Bricks() = default;

  BrickLayout layout;
  glm::dmat4 indexToWorld{1};  // an affine transform
  // The box of active voxels and of others that differ from the background, of both grids, grown by one voxel.
  IndexBox domain;
  Range value;     // over all voxels, the background included
  Range gradient;  // over all bricks; {0, 0} without gradients
  float background = 0;
  // A value near which most voxels lie that are not background, where these lie together far from 0 (such as pressures
  // around 101 325); else 0. Single precision has more digits for distances from it than for the values themselves.
  float anchor = 0;
  bool hasGradients = false;
  GradientFilter gradientFilter = GradientFilter::central;
  bool hasEmission = false;  // there are values of a second grid, which emits light
  Range emission{0, 0};      // over all of its voxels, the background included
  float emissionBackground = 0;
  VoxelFormat exactFormat = VoxelFormat::float32;
  std::uint64_t nonFiniteVoxels = 0;  // active NaN or infinite voxels, which read as background
  // The cells whose interior or apron holds anything but background, of either grid, or a gradient; ascending in z,
  // then y, then x. Among them are cells beyond the domain whose aprons reach into it, since a slab whose middle lies
  // in such a cell may reach into the domain, too.
  std::vector<Brick> bricks;

  /// Returns how far beyond its faces a brick sees voxels: the apron, and one voxel more with gradients.
  int margin() const { return layout.apron + (hasGradients ? 1 : 0); }
  /// Returns the box from which a slab or a gradient may reach into the domain: the domain grown by the margin.
  IndexBox reach() const;

  /// Reads the voxels of the cell whose first owned voxel is `origin`, which may be any lattice cell, also one that is
  /// not in `bricks`. They are x fastest, edge() voxels along each axis, beginning at origin - apron. Several threads
  /// may call this at the same time.
  /// @param gradients  empty, or receives the gradient magnitude of each voxel by gradientFilter, in grid units per
  ///                   world unit
  /// @throw InvalidArgument  a span of the wrong size, or gradients without hasGradients
  virtual void read(const glm::ivec3& origin, std::span<float> values, std::span<float> gradients = {}) const = 0;
  /// Reads the voxels of the second grid, as read() does those of the first.
  /// @throw InvalidArgument  a span of the wrong size, or there is no second grid
  virtual void readEmission(const glm::ivec3& origin, std::span<float> values) const;
};

/// Checks that bricks have the gradients that 2D transfer functions ask for, found by the filter.
/// @throw InvalidArgument
void requireGradients(const Bricks& bricks, GradientFilter filter);

/// Returns the cells of the lattice that meet reach() and are not in `bricks`. They must be drawn when the
/// background is visible.
/// @throw InvalidArgument  there are more than `limit`; the message says how many and names the background value
std::vector<Brick> backgroundBricks(const Bricks& bricks, std::size_t limit = 1u << 20);

}  // namespace umbrick
