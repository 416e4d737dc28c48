// SPDX-License-Identifier: Apache-2.0
#include "convert_source.h"

#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "convert_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

std::unique_ptr<VoxelSource> openInput(const ConvertOptions& options) {
  OpenOptions open;
  open.series = options.series;
  const glm::dvec3 spacing(options.spacing[0], options.spacing[1], options.spacing[2]);
  const glm::dvec3 origin(options.origin[0], options.origin[1], options.origin[2]);
  if (options.raw()) {
    if (options.dims.size() != 3 || options.type.empty())
      throw UsageError(options.input.string() + ": headerless raw needs --dims and --type");
    RawOptions raw;
    raw.dims = {options.dims[0], options.dims[1], options.dims[2]};
    raw.type = *voxelTypeFromName(options.type);
    raw.endian = options.endian == "big" ? std::endian::big : std::endian::little;
    raw.headerBytes = options.headerBytes;
    if (options.bitsStored != 0) raw.bitsStored = options.bitsStored;
    raw.spacing = spacing;
    raw.origin = origin;
    open.raw = raw;
  } else {
    if (options.hasSpacing) open.spacing = spacing;
    if (options.hasOrigin) open.origin = origin;
  }
  try {
    return openVolume(options.input, open);
  } catch (const UnknownFormat& error) {
    throw UsageError(std::string(error.what()) + ": give --dims and --type");
  } catch (const SeveralSeries& error) {
    throw UsageError(std::string(error.what()) + "; give --series");
  } catch (const InvalidArgument& error) {
    throw UsageError(error.what());
  }
}

std::unique_ptr<VoxelSource> cropped(const ConvertOptions& options, std::unique_ptr<VoxelSource> source) {
  return options.crop ? cropSource(std::move(source), cropBox(options)) : std::move(source);
}

}  // namespace

void expectFile(const ConvertOptions& options, const std::string& option) {
  if (fs::exists(options.input) && !fs::is_regular_file(options.input) && !fs::is_directory(options.input))
    throw UsageError(options.input.string() + ": " + option + " reads the input twice: expected a file, found a pipe");
}

std::unique_ptr<VoxelSource> openMask(const ConvertOptions& options) {
  ConvertOptions mask = options;
  mask.input = options.mask;
  mask.series.clear();
  mask.headerBytes = 0;
  mask.bitsStored = 0;
  if (formatOfName(mask.input)) {
    mask.dims.clear();
    mask.type.clear();
  } else if (!mask.type.empty()) {
    mask.type = options.maskType;
  }
  return openInput(mask);
}

std::unique_ptr<VoxelSource> openFiltered(const ConvertOptions& options, ReadNotes& notes) {
  auto source = openInput(options);
  if (!options.mask.empty()) {
    auto mask = holdsGrids(options.mask)
                    ? gridSource(options.mask.string(), readScalarGrid(options.mask).grid, source->info().dims)
                    : openMask(options);
    source = maskSource(std::move(source), std::move(mask), options.build.background.value_or(0), &notes.leftOut);
  }
  source = cropped(options, std::move(source));
  if (options.resample.empty()) return source;
  const std::vector<double>& s = options.resample;
  return resampleSource(std::move(source), {s.front(), s[s.size() / 2], s.back()}, notes.resampled);
}

BorderMode findBackground(ConvertOptions& options) {
  expectFile(options, "--background auto");
  const BorderMode mode = borderMode(*cropped(options, openInput(options)));
  options.build.background = mode.value;
  return mode;
}

}  // namespace umbrick::tools
