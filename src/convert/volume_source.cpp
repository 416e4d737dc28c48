// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_source.h"

#include <exception>
#include <utility>

#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

std::unique_ptr<VoxelSource> openInput(const fs::path& input, const OpenOptions& options) try {
  return openVolume(input, options);
} catch (const InvalidArgument& error) {
  std::throw_with_nested(OptionsError(error.what()));
}

std::unique_ptr<VoxelSource> cropped(const SourceOptions& options, std::unique_ptr<VoxelSource> source) {
  return options.crop ? cropSource(std::move(source), *options.crop) : std::move(source);
}

// A mask may state its place in another unit of length.
std::unique_ptr<VoxelSource> inUnitOf(const VoxelSource& source, std::unique_ptr<VoxelSource> mask) {
  const auto unit = [](const VoxelSource& of) {
    const auto found = of.info().metadata.find("length_unit");
    return found == of.info().metadata.end() ? std::string() : found->second;
  };
  const std::string wanted = unit(source), found = unit(*mask);
  const bool known = wanted == "nm" || wanted == "um" || wanted == "mm" || wanted == "cm" || wanted == "m";
  if (!known || found.empty() || found == wanted) return mask;
  return inLengthUnit(std::move(mask), wanted);
}

}  // namespace

void expectFile(const fs::path& input, const std::string& field) {
  if (fs::exists(input) && !fs::is_regular_file(input) && !fs::is_directory(input))
    throw OptionsError(input.string() + ": " + field + " reads the input twice: expected a file, found a pipe");
}

std::unique_ptr<VoxelSource> openMask(const SourceOptions& options) {
  return openInput(options.mask, options.openMask);
}

ScalarGrid readMaskGrid(const fs::path& mask) try { return readScalarGrid(mask); } catch (const SeveralGrids& error) {
  throw InvalidArgument(std::string(error.what()) + "; a mask is the only scalar grid of its file, or called density");
}

std::unique_ptr<VoxelSource> openFiltered(const fs::path& input, const SourceOptions& options, float background,
                                          ReadNotes& notes) {
  auto source = openInput(input, options.open);
  if (!options.mask.empty()) {
    auto mask = holdsGrids(options.mask)
                    ? gridSource(options.mask.string(), readMaskGrid(options.mask).grid, source->info().dims)
                    : inUnitOf(*source, openMask(options));
    source = maskSource(std::move(source), std::move(mask), background, &notes.leftOut);
  }
  source = cropped(options, std::move(source));
  return options.resample ? resampleSource(std::move(source), *options.resample, notes.resampled) : std::move(source);
}

BorderMode findBackground(const fs::path& input, const SourceOptions& options) {
  expectFile(input, "source.backgroundFromBorder");
  return borderMode(*cropped(options, openInput(input, options.open)));
}

}  // namespace umbrick
