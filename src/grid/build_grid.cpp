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
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

openvdb::FloatGrid::Ptr emptyGrid(const VolumeInfo& info, const BuildOptions& options, float background) {
  auto grid = openvdb::FloatGrid::create(background);
  placeVolumeGrid(info, options.name, *grid);
  grid->setSaveFloatAsHalf(options.half);
  return grid;
}

}  // namespace

BuiltGrid buildGrid(VoxelSource& source, const BuildOptions& options) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  const SparseRule rule(info.name, options, 0);
  BuiltGrid built{emptyGrid(info, options, rule.background()), {}};
  const std::int64_t sliceVoxels = info.dims.x * info.dims.y;
  const std::int64_t atOnce = slabSlices(info.dims);
  checkSlabFits(info, std::min(atOnce, info.dims.z));

  // A leaf of 512 voxels also has masks and its place.
  constexpr double kLeafBytes =
      static_cast<double>(sizeof(openvdb::FloatTree::LeafNodeType) + 512 * sizeof(float)) / 512;
  SlabBuilder builder(info.dims, rule);
  SparseTally tally;
  VoxelSlab slab(source), next(source);
  built.report.conversionError = slab.read(0, atOnce);
  while (slab.slices() > 0) {
    // Voxels that all stay take this much; the sparse rule tells how many do, voxel by voxel.
    requireMemory(info.name + ": building the grid, slices " + std::to_string(slab.firstSlice()) + " to " +
                      std::to_string(slab.firstSlice() + slab.slices() - 1) + " of " + std::to_string(info.dims.z),
                  kLeafBytes * static_cast<double>(slab.slices() * sliceVoxels));
    // The next voxel slab is read while the leaves of this one are built.
    auto reading = std::async(std::launch::async, [&] { return next.read(slab.firstSlice() + slab.slices(), atOnce); });
    tally.add(builder.addTo(built.grid->tree(), slab));
    built.report.conversionError = std::max(built.report.conversionError, reading.get());
    slab.swap(next);
    if (options.progress) options.progress(static_cast<double>(slab.firstSlice()) / static_cast<double>(info.dims.z));
  }
  BuildOptions stored = options;
  if (options.maxError) {
    stored = storageWithin(built.grid->tree(), options);
    tally.add(sparsifyTree(built.grid->tree(), SparseRule(info.name, stored, rule.background())));
    built.grid->setSaveFloatAsHalf(stored.half);
  }
  checkTally(info.name, tally);
  // Equal neighbours become larger tiles, which adds no error to that of the leaves.
  openvdb::tools::prune(built.grid->tree());
  built.report.voxels = static_cast<std::uint64_t>(sliceVoxels) * static_cast<std::uint64_t>(info.dims.z);
  describe(*built.grid, tally, stored, built.report);
  return built;
}

}  // namespace umbrick
