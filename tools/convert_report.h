// What umbrick convert prints about a grid that it built.
#pragma once
#include <cstdint>
#include <string>

#include "umbrick/grid/build_grid.h"
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

/// What reading the written grid back has shown, on stdout, and a complaint on stderr where that is worse than stated.
/// @return whether it is not
bool printVerified(const VerifyReport& seen, const BuildReport& stated);

}  // namespace umbrick::tools
