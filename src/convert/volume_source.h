// Volumes as they are converted: masked, then cropped, then resampled.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "umbrick/convert/convert_options.h"
#include "umbrick/grid/resample.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/grid/source_filters.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// What is known of a volume when it has been read to its end.
struct ReadNotes {
  std::uint64_t leftOut = 0;  // by the mask
  std::shared_ptr<ResampleReport> resampled = std::make_shared<ResampleReport>();
};

/// Opens a volume as openVolume does. @throw SeveralParts  as it does  @throw OptionsError  what else it refuses
std::unique_ptr<VoxelSource> openInput(const std::filesystem::path& input, const OpenOptions& options);

/// @param background  of what the mask leaves out, grid units
/// @param notes       outlive the source
/// @param opened      the input, where it is open already
std::unique_ptr<VoxelSource> openFiltered(const std::filesystem::path& input, const SourceOptions& options,
                                          float background, ReadNotes& notes, std::unique_ptr<VoxelSource> opened = {});

/// Opens the mask, which is a volume.
std::unique_ptr<VoxelSource> openMask(const SourceOptions& options);

/// Reads the mask where it is a file of grids. @throw InvalidArgument  it has several, none of which is called density
ScalarGrid readMaskGrid(const std::filesystem::path& mask);

/// Finds the value that most of the border of the volume has.
BorderMode findBackground(const std::filesystem::path& input, const SourceOptions& options);

/// Finds the value that most of the border has, or else the median of the border: measured or simulated floats seldom
/// repeat, and one that does by chance says nothing.
BorderMode typicalBorder(const std::filesystem::path& input, const SourceOptions& options);

/// Whether an input is there that can be read but once.
bool isPipe(const std::filesystem::path& input);

/// Sources are streams: what wants to see the voxels twice opens them again.
/// @param field  that wants to  @throw OptionsError  the input is a pipe
void expectFile(const std::filesystem::path& input, const std::string& field);

}  // namespace umbrick
