// Where rows of voxels lie among bricks, and rows of numbers made of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "sweep/brick_voxels.h"
#include "sweep/ray_lattice.h"
#include "sweep/row_kernels.h"

namespace umbrick {

/// A brick of a row of bricks along u.
struct RowBrick {
  std::int32_t first = 0;             // its first owned voxel along u
  const VoxelBrick* brick = nullptr;  // none: nothing of it is visible, so that its voxels are not held
  float value = 0;                    // then: a value that it has
};

/// The bricks of a volume in rows along the axis u of a lattice, by where they lie along v and n.
class BrickRows {
 public:
  BrickRows(const BrickVoxels& voxels, const RayLattice& axes);

  /// Returns the bricks that own voxels (v, n), ascending in u; none where there are none.
  std::span<const RowBrick> at(std::int64_t v, std::int64_t n) const;
  /// The first owned voxel, along v, of the bricks that own voxel v; likewise along n.
  std::int64_t firstV(std::int64_t v) const { return firstOf(v, base_.y, interior_.y); }
  std::int64_t firstN(std::int64_t n) const { return firstOf(n, base_.z, interior_.z); }
  glm::ivec3 interior() const { return interior_; }  // along (u, v, n)
  /// The space that visible bricks own, along (u, v, n): low <= voxel < high. Equal where there is none.
  glm::ivec3 low() const { return low_; }
  glm::ivec3 high() const { return high_; }

  /// Cells begin <= u < end of a row, the spaces between voxels u and u + 1.
  struct Cells {
    std::int32_t begin = 0, end = 0;
  };
  /// Returns the cells of row (v, n) that show something, ascending and apart. Cell (u, v, n) lies between voxels u and
  /// u + 1, and so on.
  std::span<const Cells> activeCells(std::int64_t v, std::int64_t n) const;

 private:
  static std::int64_t cellOf(std::int64_t at, std::int64_t base, std::int64_t interior) {
    const std::int64_t offset = at - base;
    return offset >= 0 ? offset / interior : -((interior - 1 - offset) / interior);
  }
  static std::int64_t firstOf(std::int64_t at, std::int64_t base, std::int64_t interior) {
    return base + cellOf(at, base, interior) * interior;
  }

  const BrickVoxels& voxels_;
  glm::ivec3 interior_, base_{0}, low_{0}, high_{0};
  int u_, v_, n_;
  std::int64_t rowsV_ = 0, rowsN_ = 0;
  std::vector<std::uint32_t> start_;  // of each row in bricks_
  void collectActive();

  std::vector<RowBrick> bricks_;
  // Of each row of groups, by brick and then by group along v and n.
  std::vector<std::uint32_t> activeStart_;
  std::vector<Cells> active_;
};

/// Makes rows of numbers on a slice: the value in steps of the table, and where there are any the gradient and light.
class RowReader {
 public:
  /// @param lights     channels of light that bricks have
  /// @param lightUnit  what one unit of their numbers stands for
  /// @param classified  bricks have media, which are read in place of values
  RowReader(const BrickVoxels& voxels, const BrickRows& rows, const RayLattice& axes, const MediumTable& table,
            int lights, float lightUnit, bool classified = false);

  /// Tells whether there is a field, see kMostFields.
  bool has(int field) const {
    if (field == 0) return true;
    if (field == 1) return table_.is2d() && !classified_;
    if (field == kEmissionField) return false;  // shear-warp does not render it
    return field < kColourFields ? field - kLightFields < lights_ : classified_;
  }
  /// Interpolates voxels begin <= u < end of the row at (v, n), which need not be whole. Each field's row is followed
  /// by kRowPadding numbers.
  void read(double v, double n, std::int64_t begin, std::int64_t end);
  const float* row(int field) const { return buffers_[static_cast<std::size_t>(field)].data(); }

 private:
  // Where a row lies: behind voxel (v, n) by shares of a voxel.
  struct Place {
    std::int64_t v = 0, n = 0;
    float shareV = 0, shareN = 0;
  };
  void readBrick(const RowBrick& at, const Place& place, std::int64_t firstV, std::int64_t firstN);
  void spreadLight();

  const BrickVoxels& voxels_;
  const BrickRows& rows_;
  const MediumTable& table_;
  int u_, v_, n_, lights_;
  float lightUnit_, empty_;  // what is read where nothing is held
  bool classified_;
  std::array<std::vector<float>, kMostFields> buffers_;
  std::int64_t begin_ = 0, end_ = 0;  // of the row that is read
};

}  // namespace umbrick
