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

namespace umbrick {

/// Of the finite active values, each voxel counted once, those of tiles included.
struct ValueSummary {
  bool magnitude = false;  // of vectors: what follows is of their length
  double min = 0, max = 0;
  std::vector<std::uint64_t> histogram;  // equal bins from min to max, both ends included
  std::uint64_t nonFinite = 0;           // active voxels that are NaN or infinite
};

struct GridSummary {
  std::string label;      // what readScalarGrid takes
  std::string valueType;  // "float", "vec3s", "mask", ...
  bool scalar = false;    // readScalarGrid takes it
  bool readable = false;  // false for points and other types: only what is above and transform and metadata are told
  bool savedAsHalf = false;
  std::string gridClass;
  IndexBox activeBox;  // of the active voxels; empty for an empty grid
  std::uint64_t activeVoxels = 0, activeTiles = 0, leaves = 0;
  std::optional<ValueSummary> values;  // none when no active value is finite, or for masks, points and unknown types
  std::string background;              // empty where the type is unknown
  std::string transformType;           // "linear" or "frustum"
  glm::dvec3 voxelSize{0};             // world units
  std::optional<glm::dmat4> indexToWorld;  // of linear transforms
  Box worldBounds;                         // of the centres of the active voxels
  std::uint64_t memoryBytes = 0;           // with its tree loaded
  std::int64_t fileBytes = 0;              // of this grid in the file
  std::map<std::string, std::string> metadata;
};

struct FileSummary {
  std::int64_t fileBytes = 0;
  std::string version;         // of the file format: "224", or "32.4" of NanoVDB
  std::string libraryVersion;  // of the OpenVDB that wrote it; "NanoVDB 32.4" for a .nvdb file
  std::map<std::string, std::string> metadata;
  std::vector<GridSummary> grids;
};

/// Reads all grids of a file, one after the other.
/// @param bins  of the histograms
/// @throw IoError          missing, a directory, truncated, corrupt or not a .vdb file
/// @throw InvalidArgument  bins < 1
FileSummary summariseFile(const std::filesystem::path& path, int bins = 16);

}  // namespace umbrick
