// NanoVDB files (.nvdb) as OpenVDB grids. NanoVDB itself is seen by the .cpp file alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

struct NanoGridEntry {
  std::string name, valueType;  // "float" also for grids of quantised floats
  std::int64_t fileBytes = 0;
  openvdb::GridBase::Ptr grid;  // null for types that are not scalar
};

bool isNanoVdb(std::span<const char> file);

/// Reads all grids of a file. A NanoVDB grid is a block of memory whose nodes point at each other, so every pointer is
/// checked before it is followed.
/// @param version  becomes the version of the file, as "32.4"
/// @throw BrokenVdb  the file is not what it claims to be
std::vector<NanoGridEntry> readNanoGrids(std::span<const char> file, std::string& version);

}  // namespace umbrick
