// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/build_grid.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <future>
#include <memory>

#include "grid/empty_grid.h"
#include "grid/slab_builder.h"
#include "grid/sparse_rule.h"
#include "umbrick/core/memory.h"
#include "umbrick/grid/build_grids.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

openvdb::FloatGrid::Ptr emptyGrid(const VolumeInfo& info, const BuildOptions& options, float background) {
  auto grid = openvdb::FloatGrid::create(background);
  placeVolumeGrid(info, options.name, *grid);
  grid->setSaveFloatAsHalf(options.half);
  return grid;
}

// A grid on its way: slab after slab, then what is done once all are there.
class GridAssembly {
 public:
  GridAssembly(const VolumeInfo& info, const BuildOptions& options)
      : info_(info),
        options_(options),
        rule_(info.name, options, 0),
        built_{emptyGrid(info, options, rule_.background()), {}},
        builder_(info.dims, rule_) {}
  GridAssembly(const GridAssembly&) = delete;
  GridAssembly& operator=(const GridAssembly&) = delete;

  /// Refuses a slab whose leaves will not fit. @throw Error
  void requireRoom(const VoxelSlab& slab) const {
    // A leaf of 512 voxels also has masks and its place.
    constexpr double kLeafBytes =
        static_cast<double>(sizeof(openvdb::FloatTree::LeafNodeType) + 512 * sizeof(float)) / 512;
    // Voxels that all stay take this much; the sparse rule tells how many do, voxel by voxel.
    requireMemory(info_.name + ": building the grid, slices " + std::to_string(slab.firstSlice()) + " to " +
                      std::to_string(slab.firstSlice() + slab.slices() - 1) + " of " + std::to_string(info_.dims.z),
                  kLeafBytes * static_cast<double>(slab.slices() * info_.dims.x * info_.dims.y));
  }
  void add(const VoxelSlab& slab) { tally_.add(builder_.addTo(built_.grid->tree(), slab)); }
  void addConversionError(double error) {
    built_.report.conversionError = std::max(built_.report.conversionError, error);
  }

  BuiltGrid finish() {
    BuildOptions stored = options_;
    if (options_.maxError) {
      stored = storageWithin(built_.grid->tree(), options_);
      tally_.add(sparsifyTree(built_.grid->tree(), SparseRule(info_.name, stored, rule_.background())));
      built_.grid->setSaveFloatAsHalf(stored.half);
    }
    checkTally(info_.name, tally_);
    // Equal neighbours become larger tiles, which adds no error to that of the leaves.
    openvdb::tools::prune(built_.grid->tree());
    built_.report.voxels =
        static_cast<std::uint64_t>(info_.dims.x * info_.dims.y) * static_cast<std::uint64_t>(info_.dims.z);
    describe(*built_.grid, tally_, stored, built_.report);
    return std::move(built_);
  }

 private:
  const VolumeInfo& info_;
  const BuildOptions& options_;
  SparseRule rule_;
  BuiltGrid built_;
  SlabBuilder builder_;
  SparseTally tally_;
};

}  // namespace

BuiltGrid buildGrid(VoxelSource& source, const BuildOptions& options) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  GridAssembly grid(info, options);
  const std::int64_t atOnce = slabSlices(info.dims);
  checkSlabFits(info, std::min(atOnce, info.dims.z));
  VoxelSlab slab(source), next(source);
  grid.addConversionError(slab.read(0, atOnce));
  while (slab.slices() > 0) {
    grid.requireRoom(slab);
    // The next voxel slab is read while the leaves of this one are built.
    auto reading = std::async(std::launch::async, [&] { return next.read(slab.firstSlice() + slab.slices(), atOnce); });
    grid.add(slab);
    grid.addConversionError(reading.get());
    slab.swap(next);
    if (options.progress) options.progress(static_cast<double>(slab.firstSlice()) / static_cast<double>(info.dims.z));
  }
  return grid.finish();
}

std::vector<BuiltGrid> buildGrids(const std::vector<VoxelSource*>& sources, const std::vector<BuildOptions>& options) {
  openvdb::initialize();
  std::vector<BuiltGrid> built;
  if (sources.empty()) return built;
  const VolumeInfo& first = sources.front()->info();
  const std::int64_t atOnce = slabSlices(first.dims);
  const auto count = static_cast<std::int64_t>(sources.size());
  checkSlabFits(first, count * std::min(atOnce, first.dims.z));
  std::vector<std::unique_ptr<GridAssembly>> grids;
  for (std::size_t i = 0; i < sources.size(); ++i)
    grids.push_back(std::make_unique<GridAssembly>(sources[i]->info(), options[i]));
  for (std::int64_t begin = 0; begin < first.dims.z; begin += atOnce) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      VoxelSlab slab(*sources[i]);
      grids[i]->addConversionError(slab.read(begin, atOnce));
      grids[i]->requireRoom(slab);
      grids[i]->add(slab);
    }
    if (options.front().progress)
      options.front().progress(static_cast<double>(std::min(begin + atOnce, first.dims.z)) /
                               static_cast<double>(first.dims.z));
  }
  for (const auto& grid : grids) built.push_back(grid->finish());
  return built;
}

}  // namespace umbrick
