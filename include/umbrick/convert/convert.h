// Volumes of any format, and files of grids, to a file of sparse grids in one call:
//
//   ConvertOptions options;
//   options.build.tolerance = 2;  // grid units
//   options.verify = true;
//   const ConvertReport report = convert({"head.nii.gz"}, "head.vdb", options);
//   std::cout << report.grids.front().build.maxError << '\n';
//
// Headerless raw voxels need to be described, also in one line:
//
//   options.source.open.raw = RawOptions{.dims = {256, 256, 128}, .type = VoxelType::u8};
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"

namespace umbrick {

/// Converts one file of grids, or one or more volumes, each of which becomes a grid of the output. The file is written
/// whole or not at all.
/// @throw OptionsError     the options do not go together, or do not fit the inputs or the output
/// @throw InvalidArgument  values of options that turn out not to fit the voxels: see cropSource, maskSource,
///                         resampleSource, borderMode, buildGrid, makeIsosurface and the writers
/// @throw IoError          an input cannot be read, or the output cannot be written
/// @throw Error            with `verify`, the file that was written is worse than stated
ConvertReport convert(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output,
                      const ConvertOptions& options = {});

/// Does the same for inputs that are volumes.
ConvertReport convertVolumes(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output,
                             const ConvertOptions& options = {});

/// Does the same for a file of grids. Its grids keep names, classes, transforms and metadata.
/// @throw OptionsError  also for a mask or a box that does not fit the grids
ConvertReport convertGrids(const std::filesystem::path& input, const std::filesystem::path& output,
                           const ConvertOptions& options = {});

}  // namespace umbrick
