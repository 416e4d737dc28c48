// SPDX-License-Identifier: Apache-2.0
#include "info_grids.h"

#include <algorithm>
#include <iostream>

#include "info_text.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "umbrick/vdb/summary.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

nlohmann::json numberOrText(const std::string& text) {
  const nlohmann::json number = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  return number.is_number() ? number : nlohmann::json(text);
}

nlohmann::json toJson(const GridSummary& grid) {
  const glm::i64vec3 dims = grid.activeBox.extent();
  nlohmann::json out{{"name", grid.label},
                     {"type", grid.valueType},
                     {"scalar", grid.scalar},
                     {"readable", grid.readable},
                     {"saved_as_half", grid.savedAsHalf},
                     {"class", grid.gridClass},
                     {"dims", jsonVector(dims)},
                     {"active_voxels", grid.activeVoxels},
                     {"active_tiles", grid.activeTiles},
                     {"leaves", grid.leaves},
                     {"background", numberOrText(grid.background)},
                     {"transform", grid.transformType},
                     {"voxel_size", jsonVector(grid.voxelSize)},
                     {"memory_bytes", grid.memoryBytes},
                     {"file_bytes", grid.fileBytes},
                     {"metadata", grid.metadata}};
  if (!grid.activeBox.empty()) {
    out["index_box"] = {{"min", jsonVector(grid.activeBox.min)}, {"max", jsonVector(grid.activeBox.max)}};
    out["world_bounds"] = {{"min", jsonVector(grid.worldBounds.min)}, {"max", jsonVector(grid.worldBounds.max)}};
  }
  if (grid.indexToWorld) out["index_to_world"] = jsonMatrix(*grid.indexToWorld);
  if (grid.values)
    out["values"] = {{"of", grid.values->magnitude ? "magnitude" : "value"},
                     {"min", grid.values->min},
                     {"max", grid.values->max},
                     {"histogram", grid.values->histogram},
                     {"non_finite", grid.values->nonFinite}};
  return out;
}

nlohmann::json toJson(const fs::path& path, const FileSummary& file) {
  nlohmann::json grids = nlohmann::json::array();
  for (const GridSummary& grid : file.grids) grids.push_back(toJson(grid));
  return {{"file", asUtf8(path.string())},
          {"file_bytes", file.fileBytes},
          {"file_version", numberOrText(file.version)},
          {"library_version", file.libraryVersion},
          {"metadata", file.metadata},
          {"grids", grids}};
}

void print(const GridSummary& grid) {
  std::cout << "grid \"" << printable(grid.label) << "\"\n  type           " << grid.valueType
            << (grid.savedAsHalf ? ", saved as half" : "") << (grid.scalar ? "" : " (not a scalar)") << '\n';
  std::cout << "  file bytes     " << grid.fileBytes << '\n';
  if (grid.transformType.empty()) {
    std::cout << "  (a type that this program does not know)\n";
    return;
  }
  if (!grid.readable) {
    std::cout << "  (voxels of this type are not read)\n";
    return;
  }
  const glm::i64vec3 dims = grid.activeBox.extent();
  std::cout << "  class          " << grid.gridClass << "\n  dimensions     " << text(dims, " x ") << " voxels";
  if (!grid.activeBox.empty())
    std::cout << ", index (" << text(grid.activeBox.min) << ") to (" << text(grid.activeBox.max) << ')';
  const double inBox = double(dims.x) * double(dims.y) * double(dims.z);
  std::cout << "\n  active voxels  " << grid.activeVoxels;
  if (inBox > 0) std::cout << " (" << 100 * double(grid.activeVoxels) / inBox << " % of the box)";
  std::cout << "\n  leaves, tiles  " << grid.leaves << ", " << grid.activeTiles << '\n';
  if (!grid.background.empty()) std::cout << "  background     " << grid.background << '\n';
  std::cout << "  transform      " << grid.transformType << ", voxel size " << text(grid.voxelSize, " x ")
            << " world units\n";
  if (!grid.worldBounds.empty())
    std::cout << "  world bounds   (" << text(grid.worldBounds.min) << ") to (" << text(grid.worldBounds.max) << ")\n";
  std::cout << "  memory bytes   " << grid.memoryBytes << '\n';
  printSource(grid.metadata);
  if (!grid.values) return;
  if (grid.values->nonFinite > 0) std::cout << "  not finite     " << grid.values->nonFinite << " active voxels\n";
  if (grid.values->histogram.empty()) return;
  std::cout << "  " << (grid.values->magnitude ? "magnitudes     " : "values         ") << grid.values->min << " to "
            << grid.values->max << ", active voxels by value:\n";
  printHistogram(grid.values->histogram, grid.values->min, grid.values->max);
}

// Leaves the grids that were asked for, in the order of the file. @throw InvalidArgument  there is no such grid
void keepNamed(const fs::path& path, const std::vector<std::string>& only, FileSummary& file) {
  if (only.empty()) return;
  const auto isNamed = [](const GridSummary& grid, const std::string& name) {
    return grid.label == name || grid.label == name + "[0]";
  };
  for (const std::string& name : only)
    if (std::none_of(file.grids.begin(), file.grids.end(), [&](const auto& grid) { return isNamed(grid, name); })) {
      std::string names;
      for (const GridSummary& grid : file.grids) names += (names.empty() ? "\"" : ", \"") + grid.label + '"';
      throw InvalidArgument(path.string() + ": no grid \"" + name + "\": the file has " +
                            (names.empty() ? "none" : names));
    }
  std::erase_if(file.grids, [&](const GridSummary& grid) {
    return std::none_of(only.begin(), only.end(), [&](const std::string& name) { return isNamed(grid, name); });
  });
}

}  // namespace

void printGridInfo(const fs::path& path, const std::vector<std::string>& only, int bins, bool json) {
  FileSummary file = summariseFile(path, bins);
  keepNamed(path, only, file);
  if (json) {
    printJson(toJson(path, file));
    return;
  }
  std::cout << printable(path.string()) << ": " << file.fileBytes << " bytes, file version " << file.version
            << ", written by " << (file.libraryVersion.starts_with("NanoVDB") ? "" : "OpenVDB ")
            << file.libraryVersion.substr(0, file.libraryVersion.find('/')) << '\n';
  printSource(file.metadata);
  for (const GridSummary& grid : file.grids) print(grid);
  if (file.grids.empty()) std::cout << "no grids\n";
}

}  // namespace umbrick::tools
