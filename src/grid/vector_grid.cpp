// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/vector_grid.h"

#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "grid/empty_grid.h"
#include "grid/slab_builder.h"
#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

using openvdb::Vec3f;
using VectorLeaf = openvdb::Vec3STree::LeafNodeType;

// What becomes of the three numbers of a voxel.
class VectorRule {
 public:
  VectorRule(const VolumeInfo& info, const BuildOptions& options)
      : background_(options.background.value_or(0)),
        tolerance_(options.tolerance),
        scale_(colourScale(info)),
        turns_(info.vectorToWorld != glm::dmat3(1)),
        turn_(info.vectorToWorld) {
    if (!(tolerance_ >= 0) || !std::isfinite(tolerance_))
      throw InvalidArgument(info.name + ": tolerance: expected a number from 0, found " + std::to_string(tolerance_));
    if (!std::isfinite(background_))
      throw InvalidArgument(info.name + ": background: expected a finite number, found " + std::to_string(background_));
  }

  float background() const { return background_; }
  Vec3f value(const float* stored) const {
    if (turns_) {
      const glm::dvec3 turned = turn_ * glm::dvec3(stored[0], stored[1], stored[2]);
      return {static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z)};
    }
    if (scale_ == 1) return {stored[0], stored[1], stored[2]};
    return {static_cast<float>(stored[0] / scale_), static_cast<float>(stored[1] / scale_),
            static_cast<float>(stored[2] / scale_)};
  }
  static bool isFinite(const Vec3f& value) {
    return std::isfinite(value[0]) && std::isfinite(value[1]) && std::isfinite(value[2]);
  }
  bool isBackground(const Vec3f& value) const {
    return std::abs(value[0] - background_) <= tolerance_ && std::abs(value[1] - background_) <= tolerance_ &&
           std::abs(value[2] - background_) <= tolerance_;
  }

 private:
  float background_, tolerance_;
  double scale_;
  bool turns_;
  glm::dmat3 turn_;
};

// The errors of the numbers of some voxels, and what else was met.
struct VectorTally {
  LossSum error;
  std::uint64_t nonFinite = 0;
  std::uint64_t wrongly = 0, active = 0;  // of a comparison
  void add(const VectorTally& other) {
    error.add(other.error);
    nonFinite += other.nonFinite;
    wrongly += other.wrongly;
    active += other.active;
  }
  void add(const Vec3f& source, const Vec3f& stored) {
    for (int k = 0; k < 3; ++k) error.add(std::abs(static_cast<double>(source[k]) - static_cast<double>(stored[k])));
  }
};

// The voxels of a volume that one leaf covers.
struct LeafBox {
  glm::i64vec3 from{0}, to{0};
  openvdb::Coord origin() const { return {int(from.x), int(from.y), int(from.z)}; }
};

// Slices of a volume, three numbers a voxel, and the leaves that they make.
class VectorSlab {
 public:
  explicit VectorSlab(VoxelSource& source) : source_(source), atOnce_(slabSlices(source.info().dims)) {
    assert(source.info().valuesPerVoxel == 3);
    checkSlabFits(source.info(), 3 * std::min(atOnce_, source.info().dims.z));
  }

  /// @return false behind the last slice
  bool next() {
    const glm::i64vec3& dims = source_.info().dims;
    first_ += slices_;
    slices_ = std::clamp<std::int64_t>(dims.z - first_, 0, atOnce_);
    if (slices_ == 0) return false;
    values_.resize(static_cast<std::size_t>(3 * dims.x * dims.y * slices_));
    error_ = std::max(error_, source_.readSlab(slices_, values_));
    return true;
  }
  double conversionError() const { return error_; }
  double share() const { return double(first_ + slices_) / double(source_.info().dims.z); }

  std::int64_t leaves() const {
    const glm::i64vec3 count = leafCounts();
    return count.x * count.y * count.z;
  }
  LeafBox leaf(std::int64_t i) const {
    const glm::i64vec3& dims = source_.info().dims;
    const glm::i64vec3 count = leafCounts();
    LeafBox box;
    box.from = glm::i64vec3(i % count.x, i / count.x % count.y, i / (count.x * count.y)) * kLeafEdge;
    box.from.z += first_;
    box.to = glm::min(box.from + kLeafEdge, glm::i64vec3(dims.x, dims.y, first_ + slices_));
    return box;
  }
  const float* voxel(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const glm::i64vec3& dims = source_.info().dims;
    return values_.data() + 3 * (((z - first_) * dims.y + y) * dims.x + x);
  }

 private:
  glm::i64vec3 leafCounts() const {
    const glm::i64vec3& dims = source_.info().dims;
    return (glm::i64vec3(dims.x, dims.y, slices_) + (kLeafEdge - 1)) / kLeafEdge;
  }

  VoxelSource& source_;
  std::int64_t atOnce_, first_ = 0, slices_ = 0;
  std::vector<float> values_;
  double error_ = 0;
};

template <class Visit>
void eachVoxel(const LeafBox& box, const VectorSlab& slab, const Visit& visit) {
  for (std::int64_t z = box.from.z; z < box.to.z; ++z)
    for (std::int64_t y = box.from.y; y < box.to.y; ++y)
      for (std::int64_t x = box.from.x; x < box.to.x; ++x)
        visit(static_cast<openvdb::Index>(((x & 7) << 6) | ((y & 7) << 3) | (z & 7)), slab.voxel(x, y, z));
}

std::unique_ptr<VectorLeaf> buildLeaf(const LeafBox& box, const VectorSlab& slab, const VectorRule& rule,
                                      VectorTally& tally) {
  const Vec3f background(rule.background());
  std::unique_ptr<VectorLeaf> leaf;
  eachVoxel(box, slab, [&](openvdb::Index at, const float* stored) {
    const Vec3f value = rule.value(stored);
    if (!VectorRule::isFinite(value)) {
      ++tally.nonFinite;
    } else if (rule.isBackground(value)) {
      tally.add(value, background);
    } else {
      if (!leaf) leaf = std::make_unique<VectorLeaf>(box.origin(), background);
      leaf->setValueOn(at, value);
    }
  });
  return leaf;
}

VectorTally addSlab(const VectorSlab& slab, const VectorRule& rule, openvdb::Vec3STree& tree) {
  std::vector<std::unique_ptr<VectorLeaf>> leaves(static_cast<std::size_t>(slab.leaves()));
  const VectorTally tally = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::int64_t>(0, slab.leaves(), 64), VectorTally{},
      [&](const tbb::blocked_range<std::int64_t>& range, VectorTally sum) {
        for (std::int64_t i = range.begin(); i != range.end(); ++i)
          leaves[static_cast<std::size_t>(i)] = buildLeaf(slab.leaf(i), slab, rule, sum);
        return sum;
      },
      [](VectorTally a, const VectorTally& b) {
        a.add(b);
        return a;
      });
  for (auto& leaf : leaves)
    if (leaf) tree.addLeaf(leaf.release());
  return tally;
}

// Compares the voxels of a leaf with those of a grid.
void compareLeaf(const LeafBox& box, const VectorSlab& slab, const VectorRule& rule,
                 const openvdb::Vec3SGrid::ConstAccessor& access, VectorTally& seen) {
  const VectorLeaf* leaf = access.probeConstLeaf(box.origin());
  Vec3f tile;
  const bool tileOn = !leaf && access.probeValue(box.origin(), tile);
  const Vec3f background(rule.background());
  eachVoxel(box, slab, [&](openvdb::Index at, const float* stored) {
    const Vec3f value = rule.value(stored);
    const Vec3f& found = leaf ? leaf->getValue(at) : tile;
    seen.active += leaf ? leaf->isValueOn(at) : tileOn;
    if (VectorRule::isFinite(value))
      seen.add(value, found);
    else
      seen.wrongly += found != background;
  });
}

std::uint64_t voxelCount(const VolumeInfo& info) {
  return static_cast<std::uint64_t>(info.dims.x * info.dims.y) * static_cast<std::uint64_t>(info.dims.z);
}

}  // namespace

double colourScale(const VolumeInfo& info) {
  using enum VoxelType;
  if (info.meaning != VoxelMeaning::colour) return 1;
  switch (info.type) {
    case u8:
      return 255;
    case i8:
      return 127;
    case u16:
      return 65535;
    case i16:
      return 32767;
    case u32:
      return 4294967295.0;
    case i32:
      return 2147483647.0;
    default:
      return 1;
  }
}

BuiltVectors buildVectorGrid(VoxelSource& source, const BuildOptions& options) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  const VectorRule rule(info, options);
  BuiltVectors built{openvdb::Vec3SGrid::create(Vec3f(rule.background())), {}};
  placeVolumeGrid(info, options.name, *built.grid);
  VectorTally tally;
  VectorSlab slab(source);
  while (slab.next()) {
    tally.add(addSlab(slab, rule, built.grid->tree()));
    if (options.progress) options.progress(slab.share());
  }
  openvdb::tools::prune(built.grid->tree());

  BuildReport& report = built.report;
  report.voxels = voxelCount(info);
  report.activeVoxels = built.grid->activeVoxelCount();
  report.activeTiles = built.grid->tree().activeTileCount();
  report.leaves = built.grid->tree().leafCount();
  report.maxError = tally.error.max;
  report.rmsError = rootMean(tally.error.squares, 3 * report.voxels);
  report.tolerance = {report.maxError, report.rmsError};
  report.storage = "three floats";
  report.conversionError = slab.conversionError() / colourScale(info);
  report.nonFinite = tally.nonFinite;
  if (report.maxError + report.conversionError > 0)
    built.grid->insertMeta("error_max", openvdb::DoubleMetadata(report.maxError + report.conversionError));
  if (report.rmsError > 0) built.grid->insertMeta("error_rms", openvdb::DoubleMetadata(report.rmsError));
  return built;
}

VerifyReport verifyVectorGrid(VoxelSource& source, const openvdb::Vec3SGrid& grid, const BuildOptions& options) {
  const VectorRule rule(source.info(), options);
  VectorTally seen;
  VectorSlab slab(source);
  while (slab.next()) {
    seen.add(tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::int64_t>(0, slab.leaves(), 64), VectorTally{},
        [&](const tbb::blocked_range<std::int64_t>& range, VectorTally sum) {
          const auto access = grid.getConstAccessor();
          for (std::int64_t i = range.begin(); i != range.end(); ++i)
            compareLeaf(slab.leaf(i), slab, rule, access, sum);
          return sum;
        },
        [](VectorTally a, const VectorTally& b) {
          a.add(b);
          return a;
        }));
    if (options.progress) options.progress(slab.share());
  }
  const std::uint64_t voxels = voxelCount(source.info());
  return {voxels,
          {seen.error.max, rootMean(seen.error.squares, 3 * voxels)},
          seen.wrongly,
          grid.activeVoxelCount() - seen.active};
}

}  // namespace umbrick
