// What umbrick convert prints about a grid that it built.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/resample.h"
#include "umbrick/grid/source_filters.h"
#include "umbrick/grid/verify.h"

namespace umbrick::tools {

/// On stdout.
/// @param dense  the source was a dense volume, not a grid
void printReport(const std::string& label, const BuildReport& report, bool dense);

/// The background that the border gave.
void printBackground(const BorderMode& mode);

/// @param voxels  that a mask made background
void printMasked(std::uint64_t voxels);

void printResampled(const ResampleReport& report);
/// Keeps the same in the metadata of the grid: resample_spacing, resample_error_max and _rms, resample_integral_before
/// and _after.
void describeResampling(openvdb::FloatGrid& grid, const ResampleReport& report);

/// What reading the written grid back has shown.
void printVerified(const VerifyReport& seen);

/// @throw Error  that is worse than stated
void checkVerified(const std::filesystem::path& output, const std::string& label, const VerifyReport& seen,
                   const BuildReport& stated);

}  // namespace umbrick::tools
