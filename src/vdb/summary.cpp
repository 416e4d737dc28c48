// SPDX-License-Identifier: Apache-2.0
#include "umbrick/vdb/summary.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "umbrick/core/error.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/scalar_grid.h"
#include "vdb/vdb_check.h"
#include "vdb/vdb_file.h"

namespace umbrick {
namespace {

using openvdb::GridBase;
using CountedGridTypes =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                      openvdb::BoolGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;

template <class Value>
double asNumber(const Value& value) {
  if constexpr (openvdb::VecTraits<Value>::IsVec)
    return std::sqrt(double(value[0]) * double(value[0]) + double(value[1]) * double(value[1]) +
                     double(value[2]) * double(value[2]));
  else
    return static_cast<double>(value);
}

// Calls add(state, value, voxels) for all active values: for leaves on all cores, then for tiles. The
// states are joined.
template <class Tree, class State, class Add>
State overActive(const Tree& tree, const State& empty, const Add& add) {
  openvdb::tree::LeafManager<const Tree> leaves(tree);
  State state = tbb::parallel_reduce(
      leaves.leafRange(64), empty,
      [&](const auto& range, State sum) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) add(sum, asNumber(*voxel), std::uint64_t(1));
        return sum;
      },
      [](State a, const State& b) {
        a.join(b);
        return a;
      });
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) add(state, asNumber(*tile), std::uint64_t(tile.getVoxelCount()));
  return state;
}

struct Extremes {
  double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
  std::uint64_t nonFinite = 0;
  void join(const Extremes& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    nonFinite += other.nonFinite;
  }
};

struct Counts {
  std::vector<std::uint64_t> bins;
  void join(const Counts& other) {
    for (std::size_t i = 0; i < bins.size(); ++i) bins[i] += other.bins[i];
  }
};

template <class Tree>
ValueSummary summariseValues(const Tree& tree, int bins) {
  const Extremes extremes = overActive(tree, Extremes{}, [](Extremes& sum, double value, std::uint64_t voxels) {
    if (!std::isfinite(value)) {
      sum.nonFinite += voxels;
      return;
    }
    sum.min = std::min(sum.min, value);
    sum.max = std::max(sum.max, value);
  });
  ValueSummary out{
      openvdb::VecTraits<typename Tree::ValueType>::IsVec, extremes.min, extremes.max, {}, extremes.nonFinite};
  if (out.min > out.max) {
    out.min = out.max = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  // All is halved, so that the extent of doubles does not overflow.
  const double start = 0.5 * out.min, extent = 0.5 * out.max - start;
  const auto binOf = [&](double value) {
    const double share = extent > 0 ? (0.5 * value - start) / extent : 0.0;
    return std::min(static_cast<std::size_t>(share * bins), static_cast<std::size_t>(bins - 1));
  };
  const Counts none{std::vector<std::uint64_t>(static_cast<std::size_t>(bins))};
  out.histogram = overActive(tree, none, [&](Counts& sum, double value, std::uint64_t voxels) {
                    if (std::isfinite(value)) sum.bins[binOf(value)] += voxels;
                  }).bins;
  return out;
}

std::map<std::string, std::string> asText(const openvdb::MetaMap& metadata) {
  std::map<std::string, std::string> out;
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
    if (entry->second) out[entry->first] = entry->second->str();
  return out;
}

std::string backgroundText(const GridBase& grid) {
  std::ostringstream text;
  text.precision(std::numeric_limits<float>::max_digits10);
  grid.apply<CountedGridTypes>([&](const auto& typed) { text << typed.background(); });
  return text.str();
}

void placeInWorld(const GridBase& grid, GridSummary& out) {
  const openvdb::math::Transform& transform = grid.transform();
  const bool linear = transform.isLinear();
  out.transformType = linear ? "linear" : "frustum";
  const openvdb::Vec3d size = transform.voxelSize();
  out.voxelSize = {size[0], size[1], size[2]};
  if (linear) out.indexToWorld = affineMatrix(transform);
}

void boundWorld(const GridBase& grid, GridSummary& out) {
  const glm::ivec3 &low = out.activeBox.min, &high = out.activeBox.max;
  for (int corner = 0; corner < 8; ++corner) {
    const openvdb::Vec3d point = grid.transform().indexToWorld(
        openvdb::Vec3d(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z));
    out.worldBounds.include({point[0], point[1], point[2]});
  }
}

// Counts what a grid holds whose type is known.
void countGrid(const GridBase& grid, int bins, GridSummary& out) {
  out.activeVoxels = grid.activeVoxelCount();
  out.activeTiles = grid.baseTree().activeTileCount();
  out.leaves = grid.baseTree().leafCount();
  if (out.activeVoxels > 0) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    out.activeBox = {{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}};
    boundWorld(grid, out);
    grid.apply<CountedGridTypes>([&](const auto& typed) { out.values = summariseValues(typed.tree(), bins); });
  }
  out.background = backgroundText(grid);
  out.memoryBytes = grid.memUsage();
}

void requireBins(int bins) {
  if (bins < 1) throw InvalidArgument("bins: expected 1 or more, found " + std::to_string(bins));
}

GridSummary summariseEntry(VdbFile& file, const VdbFile::Entry& entry, int bins) {
  GridSummary out;
  out.label = entry.label;
  out.valueType = entry.valueType;
  out.scalar = isScalarType(out.valueType);
  out.savedAsHalf = entry.descriptor.saveFloatAsHalf();
  out.fileBytes = entry.fileBytes;
  const GridBase::ConstPtr grid = file.read(entry);
  if (!grid) return out;
  out.gridClass = GridBase::gridClassToString(grid->getGridClass());
  out.metadata = asText(*grid);
  placeInWorld(*grid, out);
  out.readable = layoutOf(entry.valueType) != nullptr;
  if (out.readable) countGrid(*grid, bins, out);
  return out;
}

}  // namespace

FileSummary summariseFile(const std::filesystem::path& path, int bins) {
  requireBins(bins);
  VdbFile file(path);
  FileSummary out{file.fileBytes(), file.version(), file.writtenBy(), asText(file.metadata()), {}};
  for (const VdbFile::Entry& entry : file.entries()) out.grids.push_back(summariseEntry(file, entry, bins));
  return out;
}

GridSummary summariseGrid(const ScalarGrid& grid, int bins) {
  requireBins(bins);
  GridSummary out;
  out.label = grid.name;
  out.valueType = grid.grid->valueType();
  out.scalar = out.readable = true;
  out.savedAsHalf = grid.grid->saveFloatAsHalf();
  out.gridClass = GridBase::gridClassToString(grid.grid->getGridClass());
  out.metadata = asText(*grid.grid);
  placeInWorld(*grid.grid, out);
  countGrid(*grid.grid, bins, out);
  return out;
}

}  // namespace umbrick
