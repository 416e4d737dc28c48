// What is in a .vdb or .nvdb file, grid by grid: the facts that `umbrick info` prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/box.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// A summary of the finite active values. Each voxel is counted once, and those of tiles are included.
struct ValueSummary {
  bool magnitude = false;  // true for vectors: what follows is about their length
  double min = 0, max = 0;
  std::vector<std::uint64_t> histogram;  // equal bins from min to max, both ends included
  std::uint64_t nonFinite = 0;           // active voxels that are NaN or infinite
};

struct GridSummary {
  std::string label;      // what readScalarGrid takes to select the grid
  std::string valueType;  // "float", "vec3s", "mask", ...
  bool scalar = false;    // readScalarGrid can read it
  /// False for points and other types. Of these only what is above, the transform and the metadata are told.
  bool readable = false;
  bool savedAsHalf = false;
  std::string gridClass;
  IndexBox activeBox;  // box of the active voxels; empty for an empty grid
  std::uint64_t activeVoxels = 0, activeTiles = 0, leaves = 0;
  /// Nothing when no active value is finite, or for masks, points and unknown types.
  std::optional<ValueSummary> values;
  std::string background;                  // empty where the type is unknown
  std::string transformType;               // "linear" or "frustum"
  glm::dvec3 voxelSize{0};                 // world units
  std::optional<glm::dmat4> indexToWorld;  // nothing for transforms that are not linear
  Box worldBounds;                         // bounds of the centres of the active voxels
  std::uint64_t memoryBytes = 0;           // memory of the grid when its tree is loaded
  std::int64_t fileBytes = 0;              // bytes that the grid takes in the file
  std::map<std::string, std::string> metadata;
};

struct FileSummary {
  std::int64_t fileBytes = 0;
  std::string version;         // version of the file format: "224", or "32.4" of NanoVDB
  std::string libraryVersion;  // version of the OpenVDB that wrote the file; "NanoVDB 32.4" for a .nvdb file
  std::map<std::string, std::string> metadata;
  std::vector<GridSummary> grids;
};

/// Reads all grids of a file, one after the other.
/// @param bins  number of bins of the histograms
/// @throw IoError          the file is missing, a directory, truncated, corrupt or not a .vdb file
/// @throw InvalidArgument  bins < 1
FileSummary summariseFile(const std::filesystem::path& path, int bins = 16);

/// Does the same for a grid in memory, whose label is its name. It takes no bytes in a file.
/// @throw InvalidArgument  bins < 1
GridSummary summariseGrid(const ScalarGrid& grid, int bins = 16);

}  // namespace umbrick
