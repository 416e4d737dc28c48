// The voxels that a transfer function makes visible, in blocks of 8 x 8 x 8 cells, found by a tree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "reference/classifier.h"
#include "reference/cubic.h"
#include "reference/index_ray.h"
#include "umbrick/core/range.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/optics/gradient_filter.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// A block of the cells from origin to origin + 7 along each axis. The cell at i is the space between
/// voxels i and i + 1.
struct FieldBlock {
  static constexpr int kCells = 8, kVoxels = kCells + 1;

  const float* values = nullptr;     // kVoxels^3, x fastest; null: every voxel is `uniform`
  const float* gradients = nullptr;  // gradient magnitudes at the same voxels, for a 2D function
  const float* emissions = nullptr;  // values of a second grid at the same voxels; null: nothing is emitted
  float uniform = 0;
  double sigma_maj = 0;  // 1/world unit
  // The kinds of the cells, x fastest: kTransparent, kMixed, or 1 + the stretch of a 1D function in which all values
  // of the cell lie.
  static constexpr std::uint8_t kTransparent = 0, kMixed = 255;
  std::array<std::uint8_t, kCells * kCells * kCells> kinds{};

  std::uint8_t kind(const glm::ivec3& cell) const {
    return kinds[static_cast<std::size_t>((cell.z * kCells + cell.y) * kCells + cell.x)];
  }
  bool sees(const glm::ivec3& cell) const { return kind(cell) != kTransparent; }
};

/// Returns the range of the values, or gradients, at the corners of a cell.
inline Range rangeOfCell(const float* values, const glm::ivec3& cell) {
  constexpr int n = FieldBlock::kVoxels;
  Range range;
  for (int corner = 0; corner < 8; ++corner)
    range.include(values[((cell.z + (corner >> 2)) * n + cell.y + (corner >> 1 & 1)) * n + cell.x + (corner & 1)]);
  return range;
}

/// A trilinear cell, with its value at local coordinates in [0, 1]^3 and along a line.
class TrilinearCell {
 public:
  TrilinearCell(const float* block, const glm::ivec3& cell);
  /// @param corners  x fastest
  explicit TrilinearCell(const std::array<double, 8>& corners);
  double operator()(const glm::dvec3& p) const {
    return k0_ + p.x * kx_ + p.y * (ky_ + p.x * kxy_) + p.z * (kz_ + p.x * kxz_ + p.y * (kyz_ + p.x * kxyz_));
  }
  /// Returns the values along the line from + s (to - from).
  Cubic along(const glm::dvec3& from, const glm::dvec3& to) const;
  /// Returns the mean of the values on the line between two points. Two Gauss nodes are exact for a cubic.
  double mean(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 middle = 0.5 * (from + to), offset = 0.28867513459481287 * (to - from);
    return 0.5 * ((*this)(middle - offset) + (*this)(middle + offset));
  }

 private:
  double k0_, kx_, ky_, kz_, kxy_, kxz_, kyz_, kxyz_;
};

/// Returns the values at the corners of a cell, x fastest.
inline std::array<double, 8> cornersOf(const float* block, const glm::ivec3& cell) {
  constexpr int kVoxels = FieldBlock::kVoxels;
  const float* v = block + (cell.z * kVoxels + cell.y) * kVoxels + cell.x;
  constexpr int Y = kVoxels, Z = kVoxels * kVoxels;
  return {v[0], v[1], v[Y], v[Y + 1], v[Z], v[Z + 1], v[Z + Y], v[Z + Y + 1]};
}

inline TrilinearCell::TrilinearCell(const float* block, const glm::ivec3& cell)
    : TrilinearCell(cornersOf(block, cell)) {}

inline TrilinearCell::TrilinearCell(const std::array<double, 8>& v) {
  const double v000 = v[0], v100 = v[1], v010 = v[2], v110 = v[3];
  const double v001 = v[4], v101 = v[5], v011 = v[6], v111 = v[7];
  k0_ = v000;
  kx_ = v100 - v000;
  ky_ = v010 - v000;
  kz_ = v001 - v000;
  kxy_ = v110 - v100 - ky_;
  kxz_ = v101 - v100 - kz_;
  kyz_ = v011 - v010 - kz_;
  kxyz_ = (v111 - v101 - v011 + v001) - kxy_;
}

inline Cubic TrilinearCell::along(const glm::dvec3& p, const glm::dvec3& to) const {
  const glm::dvec3 d = to - p;
  // Returns the coefficients, by powers of s, of a product of three linear factors.
  return {{(*this)(p),
           kx_ * d.x + ky_ * d.y + kz_ * d.z + kxy_ * (p.x * d.y + p.y * d.x) + kxz_ * (p.x * d.z + p.z * d.x) +
               kyz_ * (p.y * d.z + p.z * d.y) + kxyz_ * (d.x * p.y * p.z + p.x * d.y * p.z + p.x * p.y * d.z),
           kxy_ * d.x * d.y + kxz_ * d.x * d.z + kyz_ * d.y * d.z +
               kxyz_ * (d.x * d.y * p.z + d.x * p.y * d.z + p.x * d.y * d.z),
           kxyz_ * d.x * d.y * d.z}};
}

class Field {
 public:
  // At the coordinates of a block: the index of the block, or -1 where all is transparent.
  using BlockTree = openvdb::Int32Tree;
  using Accessor = openvdb::tree::ValueAccessor<const BlockTree, false>;

  /// @param skipEmpty  false: transparent blocks are kept as well, and rays visit each cell
  /// @param filter     by which gradients are found, where the function asks for them
  /// @param emission   of the grid's second grid, whose sigma_s is emitted; null: nothing is
  Field(const ScalarGrid& grid, const Classifier& classifier, GradientFilter filter, bool skipEmpty,
        const Classifier* emission = nullptr);
  ~Field();  // where the tree is known: each file that deletes one compiles all of its virtual functions

  /// Returns the box of active voxels and of others that differ from the background, grown by one voxel.
  const IndexBox& domain() const { return domain_; }
  Accessor accessor() const { return Accessor(*tree_); }
  std::uint64_t nonFiniteVoxels() const { return nonFinite_; }
  std::uint64_t blocks() const { return denseBlocks_; }
  const FieldBlock& block(int index) const { return blocks_[static_cast<std::size_t>(index)]; }

  /// Calls visit(const FieldBlock&, origin, begin, end) for the blocks that the ray meets from `begin` to `end`,
  /// in order, until it returns false. A node of the tree that is transparent or whose cells are all alike is
  /// passed in one step.
  template <class Visit>
  void walkBlocks(Accessor& accessor, const IndexRay& ray, const Interval& part, const Visit& visit) const;

 private:
  void findDomain(const openvdb::FloatTree& tree, const openvdb::FloatTree* emission);
  void addBlocks(const ScalarGrid& grid, const Classifier& classifier, GradientFilter filter,
                 const Classifier* emission);
  int uniformBlock(float value, const TransferFunction& transfer);

  bool skipEmpty_;
  float background_ = 0;
  IndexBox domain_;
  std::uint64_t nonFinite_ = 0, denseBlocks_ = 0;
  std::vector<FieldBlock> blocks_;
  std::vector<std::unique_ptr<float[]>> storage_;
  std::unique_ptr<BlockTree> tree_;
};

template <class Visit>
void Field::walkBlocks(Accessor& accessor, const IndexRay& ray, const Interval& part, const Visit& visit) const {
  constexpr double edge = FieldBlock::kCells;
  double t = part.begin;
  while (t < part.end) {
    const glm::dvec3 here = ray.at(t);
    const double nudge = nudgeOf(ray, here);
    const glm::dvec3 p = (here + nudge * ray.direction) * (1 / edge);
    const openvdb::Coord at(floorToInt(p.x), floorToInt(p.y), floorToInt(p.z));
    if (const auto* leaf = accessor.probeConstLeaf(at)) {
      const glm::dvec3 low = edge * glm::dvec3(leaf->origin().x(), leaf->origin().y(), leaf->origin().z());
      const double next = std::min(part.end, std::max(exitOf(ray, low, low + 8 * edge), t + nudge));
      const bool goOn = walkLattice(low, edge, ray, t, next, [&](const glm::ivec3& cell, double begin, double end) {
        const int index = leaf->getValue(static_cast<openvdb::Index>(cell.x << 6 | cell.y << 3 | cell.z));
        return index < 0 || visit(blocks_[static_cast<std::size_t>(index)], low + edge * glm::dvec3(cell), begin, end);
      });
      if (!goOn) return;
      t = next;
      continue;
    }
    // A tile has one value, so the ray leaves it in one step.
    const int index = accessor.getValue(at);
    std::int64_t blocks = 1;
    if (skipEmpty_) {
      constexpr std::int64_t edges[]{4096, 4096, 128, 8};
      blocks = edges[accessor.getValueDepth(at) + 1];
    }
    const auto lowOf = [&](int x) { return static_cast<double>(std::int64_t(x) & ~(blocks - 1)) * edge; };
    const glm::dvec3 low(lowOf(at.x()), lowOf(at.y()), lowOf(at.z()));
    const double next =
        std::min(part.end, std::max(exitOf(ray, low, low + static_cast<double>(blocks) * edge), t + nudge));
    if (index >= 0 && !visit(blocks_[static_cast<std::size_t>(index)], low, t, next)) return;
    t = next;
  }
}

/// Calls visit(cell, begin, end) for the cells of a block that may be seen, from `begin` to `end` of the ray, in order,
/// until it returns false. The block must have voxels.
template <class Visit>
bool walkCells(const FieldBlock& block, const glm::dvec3& origin, const IndexRay& ray, double begin, double end,
               const Visit& visit) {
  return walkLattice(origin, 1, ray, begin, end, [&](const glm::ivec3& cell, double enter, double leave) {
    return !block.sees(cell) || visit(cell, enter, leave);
  });
}

}  // namespace umbrick
