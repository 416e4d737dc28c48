// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/verify.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>
#include <limits>
#include <vector>

#include "grid/slab_builder.h"
#include "grid/sparse_rule.h"

namespace umbrick {
namespace {

struct Seen {
  LossSum error;
  std::uint64_t wrongly = 0, active = 0;
  void add(const Seen& other) {
    error.add(other.error);
    wrongly += other.wrongly;
    active += other.active;
  }
};

VerifyReport reportOf(const Seen& seen, std::uint64_t voxels, const openvdb::FloatGrid& grid) {
  return {voxels,
          {seen.error.max, rootMean(seen.error.squares, voxels)},
          seen.wrongly,
          grid.activeVoxelCount() - seen.active};
}

class Verifier {
 public:
  Verifier(const openvdb::FloatGrid& grid, const BuildOptions& options, double backgroundError)
      : background_(grid.background()),
        backgroundError_(backgroundError),
        clipBelow_(options.clipBelow.value_or(-std::numeric_limits<float>::infinity())),
        clipAbove_(options.clipAbove.value_or(std::numeric_limits<float>::infinity())) {}

  /// Compares the voxels of one leaf or of the part of it that the volume has.
  /// @param voxels  those of the voxel slab that starts at slice `firstSlice`, x fastest
  Seen compare(const float* voxels, const glm::i64vec3& from, const glm::i64vec3& to, const glm::i64vec3& dims,
               std::int64_t firstSlice, const openvdb::FloatGrid::ConstAccessor& access) const {
    Seen seen;
    const openvdb::Coord origin(int(from.x), int(from.y), int(from.z));
    const Leaf* leaf = access.probeConstLeaf(origin);
    float tile = 0;
    const bool tileOn = !leaf && access.probeValue(origin, tile);
    for (std::int64_t z = from.z; z < to.z; ++z)
      for (std::int64_t y = from.y; y < to.y; ++y)
        for (std::int64_t x = from.x; x < to.x; ++x) {
          const auto at = static_cast<openvdb::Index>(((x & 7) << 6) | ((y & 7) << 3) | (z & 7));
          const float source = voxels[((z - firstSlice) * dims.y + y) * dims.x + x];
          const float stored = leaf ? leaf->getValue(at) : tile;
          seen.active += leaf ? leaf->isValueOn(at) : tileOn;
          compare(source, stored, 1, seen);
        }
    return seen;
  }

  /// @param voxels  the number of voxels that the values stand for
  void compare(float source, float stored, std::uint64_t voxels, Seen& seen) const {
    if (!std::isfinite(source) || source < clipBelow_ || source > clipAbove_)
      seen.wrongly += difference(stored, background_) <= backgroundError_ ? 0 : voxels;
    else
      seen.error.add(difference(source, stored), static_cast<double>(voxels));
  }

 private:
  static double difference(float a, float b) { return std::abs(static_cast<double>(a) - static_cast<double>(b)); }

  float background_;
  double backgroundError_;
  float clipBelow_, clipAbove_;
};

}  // namespace

bool VerifyReport::honours(const BuildReport& stated) const {
  constexpr double kSumRounding = 1e-9;  // of squares added up in another order
  return error.max <= stated.maxError && error.rms <= stated.rmsError * (1 + kSumRounding) && wrongly == 0 &&
         beyond == 0;
}

VerifyReport verifyGrid(VoxelSource& source, const openvdb::FloatGrid& grid, const BuildOptions& options,
                        double backgroundError) {
  const glm::i64vec3 dims = source.info().dims;
  const std::int64_t leavesX = (dims.x + kLeafEdge - 1) / kLeafEdge, leavesY = (dims.y + kLeafEdge - 1) / kLeafEdge;
  const std::int64_t atOnce = slabSlices(dims);
  const Verifier verifier(grid, options, backgroundError);
  Seen seen;
  std::vector<float> slab;
  for (std::int64_t first = 0; first < dims.z; first += atOnce) {
    const std::int64_t slices = std::min(atOnce, dims.z - first);
    slab.resize(static_cast<std::size_t>(slices * dims.x * dims.y));
    source.readSlab(slices, slab);
    seen.add(tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::int64_t>(0, leavesX * leavesY * ((slices + kLeafEdge - 1) / kLeafEdge), 64), Seen{},
        [&](const tbb::blocked_range<std::int64_t>& range, Seen sum) {
          const auto access = grid.getConstAccessor();
          for (std::int64_t i = range.begin(); i != range.end(); ++i) {
            const glm::i64vec3 from(i % leavesX * kLeafEdge, i / leavesX % leavesY * kLeafEdge,
                                    first + i / (leavesX * leavesY) * kLeafEdge);
            const glm::i64vec3 to = glm::min(from + kLeafEdge, glm::i64vec3(dims.x, dims.y, first + slices));
            sum.add(verifier.compare(slab.data(), from, to, dims, first, access));
          }
          return sum;
        },
        [](Seen a, const Seen& b) {
          a.add(b);
          return a;
        }));
    if (options.progress) options.progress(static_cast<double>(first) / static_cast<double>(dims.z));
  }
  return reportOf(seen, static_cast<std::uint64_t>(dims.x * dims.y) * static_cast<std::uint64_t>(dims.z), grid);
}

VerifyReport verifyGrid(const ScalarGrid& source, const openvdb::FloatGrid& grid, const BuildOptions& asked,
                        double backgroundError) {
  BuildOptions options = asked;
  // A level set is never clipped, only rounded.
  if (source.grid->getGridClass() == openvdb::GRID_LEVEL_SET) options.clipBelow = options.clipAbove = std::nullopt;
  const Verifier verifier(grid, options, backgroundError);
  const openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(source.grid->tree());
  Seen seen = tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), Seen{},
      [&](const auto& range, Seen sum) {
        const auto access = grid.getConstAccessor();
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            float stored = 0;
            sum.active += access.probeValue(voxel.getCoord(), stored);
            verifier.compare(*voxel, stored, 1, sum);
          }
        return sum;
      },
      [](Seen a, const Seen& b) {
        a.add(b);
        return a;
      });
  const auto access = grid.getConstAccessor();
  auto tile = source.grid->tree().cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const auto compare = [&](const openvdb::Coord& at, std::uint64_t voxels) {
      float stored = 0;
      seen.active += access.probeValue(at, stored) ? voxels : 0;
      verifier.compare(*tile, stored, voxels, seen);
    };
    // Where the other grid has a tile of the same size or larger there, one voxel tells of all.
    if (access.getValueDepth(tile.getCoord()) <= static_cast<int>(tile.getDepth()))
      compare(tile.getCoord(), tile.getVoxelCount());
    else
      for (auto voxel = tile.getBoundingBox().begin(); voxel; ++voxel) compare(*voxel, 1);
  }
  return reportOf(seen, source.grid->activeVoxelCount(), grid);
}

}  // namespace umbrick
