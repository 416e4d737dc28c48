// umbrick info tells what is in a .vdb or .nvdb file.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "command.h"
#include "opened_scene.h"
#include "umbrick/core/error.h"
#include "umbrick/vdb/summary.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct InfoOptions {
  fs::path input;
  std::vector<std::string> grids;  // only these; empty: all
  int bins = 16;
  bool json = false, suggestTransfer = false;
  VolumeOptions volume;
};

template <class Vector>
nlohmann::json array(const Vector& v) {
  return nlohmann::json::array({v.x, v.y, v.z});
}

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
                     {"dims", array(dims)},
                     {"active_voxels", grid.activeVoxels},
                     {"active_tiles", grid.activeTiles},
                     {"leaves", grid.leaves},
                     {"background", numberOrText(grid.background)},
                     {"transform", grid.transformType},
                     {"voxel_size", array(grid.voxelSize)},
                     {"memory_bytes", grid.memoryBytes},
                     {"file_bytes", grid.fileBytes},
                     {"metadata", grid.metadata}};
  if (!grid.activeBox.empty()) {
    out["index_box"] = {{"min", array(grid.activeBox.min)}, {"max", array(grid.activeBox.max)}};
    out["world_bounds"] = {{"min", array(grid.worldBounds.min)}, {"max", array(grid.worldBounds.max)}};
  }
  if (grid.indexToWorld) {
    nlohmann::json rows = nlohmann::json::array();
    for (int row = 0; row < 4; ++row) {
      nlohmann::json entries = nlohmann::json::array();
      for (int column = 0; column < 4; ++column) entries.push_back((*grid.indexToWorld)[column][row]);
      rows.push_back(entries);
    }
    out["index_to_world"] = rows;  // for column vectors
  }
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
  return {{"file", path.string()},
          {"file_bytes", file.fileBytes},
          {"file_version", numberOrText(file.version)},
          {"library_version", file.libraryVersion},
          {"metadata", file.metadata},
          {"grids", grids}};
}

template <class Vector>
std::string text(const Vector& v, const char* between = ", ") {
  std::ostringstream out;
  out << v.x << between << v.y << between << v.z;
  return out.str();
}

void printHistogram(const ValueSummary& values) {
  const auto most = values.histogram.empty() ? 0 : *std::max_element(values.histogram.begin(), values.histogram.end());
  const double bins = static_cast<double>(values.histogram.size());
  const auto edge = [&](std::size_t i) {
    const double share = static_cast<double>(i) / bins;
    return (1 - share) * values.min + share * values.max;
  };
  for (std::size_t i = 0; i < values.histogram.size(); ++i) {
    const auto bar = static_cast<std::size_t>(std::lround(40.0 * double(values.histogram[i]) / double(most)));
    char line[128];
    std::snprintf(line, sizeof line, "    %11.5g to %-11.5g %12llu ", edge(i), edge(i + 1),
                  static_cast<unsigned long long>(values.histogram[i]));
    std::cout << line << std::string(bar, '#') << '\n';
  }
}

// Prints what the source of the grid said about itself: a line for each metadata of this list that the grid has.
void printSource(const std::map<std::string, std::string>& metadata) {
  for (const char* key : {"source_format", "source_file", "modality", "series_description", "space", "length_unit",
                          "rescale", "value_unit"}) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) continue;
    std::string label = key;
    label.resize(std::max<std::size_t>(label.size() + 1, 15), ' ');
    std::cout << "  " << label << found->second << '\n';
  }
}

void print(const GridSummary& grid) {
  std::cout << "grid \"" << grid.label << "\"\n  type           " << grid.valueType
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
  printHistogram(*grid.values);
}

// Leaves the grids that were asked for, in the order of the file. @throw InvalidArgument  there is no such grid
void keepNamed(const InfoOptions& options, FileSummary& file) {
  if (options.grids.empty()) return;
  const auto isNamed = [](const GridSummary& grid, const std::string& name) {
    return grid.label == name || grid.label == name + "[0]";
  };
  for (const std::string& name : options.grids)
    if (std::none_of(file.grids.begin(), file.grids.end(), [&](const auto& grid) { return isNamed(grid, name); })) {
      std::string names;
      for (const GridSummary& grid : file.grids) names += (names.empty() ? "\"" : ", \"") + grid.label + '"';
      throw InvalidArgument(options.input.string() + ": no grid \"" + name + "\": the file has " +
                            (names.empty() ? "none" : names));
    }
  std::erase_if(file.grids, [&](const GridSummary& grid) {
    return std::none_of(options.grids.begin(), options.grids.end(),
                        [&](const std::string& name) { return isNamed(grid, name); });
  });
}

int info(const InfoOptions& options) {
  if (options.suggestTransfer) {
    if (options.grids.size() > 1)
      throw UsageError("--suggest-tf: expected one --grid, found " + std::to_string(options.grids.size()));
    VolumeOptions volume = options.volume;
    if (!options.grids.empty()) volume.grid = options.grids.front();
    std::cout << printTransferFunction(suggestFor(options.input, volume).transfer) << '\n';
    return 0;
  }
  FileSummary file = summariseFile(options.input, options.bins);
  keepNamed(options, file);
  if (options.json) {
    std::cout << toJson(options.input, file).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return 0;
  }
  std::cout << options.input.string() << ": " << file.fileBytes << " bytes, file version " << file.version
            << ", written by " << (file.libraryVersion.starts_with("NanoVDB") ? "" : "OpenVDB ")
            << file.libraryVersion.substr(0, file.libraryVersion.find('/')) << '\n';
  for (const GridSummary& grid : file.grids) print(grid);
  if (file.grids.empty()) std::cout << "no grids\n";
  return 0;
}

}  // namespace

Command addInfo(CLI::App& app) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Describe every grid of a .vdb or .nvdb (NanoVDB) file.");
  command->add_option("file", options->input, "a .vdb or .nvdb file")->required();
  command->add_option("--bins", options->bins, "of the histogram of the active values")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command->add_flag("--json", options->json, "JSON instead of text");
  command->add_flag("--suggest-tf", options->suggestTransfer,
                    "print the transfer function that --tf auto makes, of a volume of any format");
  addVolumeOptions(*command, options->volume);
  // Several grids are described, of which a picture would show one.
  command->remove_option(command->get_option("--grid"));
  command
      ->add_option("--grid", options->grids,
                   "of a file of grids: only this one, \"name\" or \"name[1]\"; may be repeated [all]")
      ->allow_extra_args(false)
      ->group("Volume");
  return {command, [options] { return info(*options); }};
}

}  // namespace umbrick::tools
