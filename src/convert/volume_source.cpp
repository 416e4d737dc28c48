// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_source.h"

#include <exception>
#include <utility>

#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/ingest/world.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

std::unique_ptr<VoxelSource> cropped(const SourceOptions& options, std::unique_ptr<VoxelSource> source) {
  return options.crop ? cropSource(std::move(source), *options.crop) : std::move(source);
}

}  // namespace

bool isPipe(const fs::path& input) {
  return fs::exists(input) && !fs::is_regular_file(input) && !fs::is_directory(input);
}

void expectFile(const fs::path& input, const std::string& field) {
  if (isPipe(input))
    throw OptionsError(input.string() + ": " + field + " reads the input twice: expected a file, found a pipe");
}

std::unique_ptr<VoxelSource> openMask(const SourceOptions& options) {
  return openInput(options.mask, options.openMask);
}

ScalarGrid readMaskGrid(const fs::path& mask) try { return readScalarGrid(mask); } catch (const SeveralGrids& error) {
  throw InvalidArgument(std::string(error.what()) + "; a mask is the only scalar grid of its file, or called density");
}

std::unique_ptr<VoxelSource> openInput(const fs::path& input, const OpenOptions& options) try {
  return openVolume(input, options);
} catch (const SeveralParts&) {
  throw;
} catch (const InvalidArgument& error) {
  std::throw_with_nested(OptionsError(error.what()));
}

std::unique_ptr<VoxelSource> openFiltered(const fs::path& input, const SourceOptions& options, float background,
                                          ReadNotes& notes, std::unique_ptr<VoxelSource> opened) {
  auto source = opened ? std::move(opened) : openInput(input, options.open);
  if (options.world) source = inWorld(std::move(source), *options.world, /*assumed=*/true);
  if (!options.mask.empty()) {
    auto mask = holdsGrids(options.mask)
                    ? gridSource(options.mask.string(), readMaskGrid(options.mask).grid, source->info().dims)
                    : openMask(options);
    // A mask that does not state its world has that of the input, since its voxels must lie at the same places.
    mask = inWorld(std::move(mask), worldOf(source->info()), /*assumed=*/false);
    source = maskSource(std::move(source), std::move(mask), background, &notes.leftOut);
  }
  source = cropped(options, std::move(source));
  return options.resample ? resampleSource(std::move(source), *options.resample, notes.resampled) : std::move(source);
}

BorderMode typicalBorder(const fs::path& input, const SourceOptions& options) {
  constexpr std::uint64_t kLeastShare = 100;  // one border voxel in so many has a value that stands out
  ReadNotes notes;
  SourceOptions whole = options;
  whole.mask.clear();  // what it leaves out becomes background itself
  whole.resample.reset();
  BorderMode mode = borderValues(*openFiltered(input, whole, 0, notes));
  if (mode.voxels * kLeastShare < mode.border) mode.value = mode.median;
  return mode;
}

BorderMode findBackground(const fs::path& input, const SourceOptions& options) {
  expectFile(input, "source.backgroundFromBorder");
  return borderMode(*cropped(options, openInput(input, options.open)));
}

}  // namespace umbrick
