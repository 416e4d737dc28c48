// SPDX-License-Identifier: Apache-2.0
#include "convert/grid_names.h"

#include <map>

#include "umbrick/convert/options_error.h"
#include "umbrick/ingest/vtk_volume.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

std::string stemOf(fs::path path) {
  if (const std::string array = vtkArrayName(path); !array.empty()) return array;
  if (!path.has_filename()) path = path.parent_path();  // a folder, written with a slash behind it
  for (const char* packing : {".gz", ".xz", ".zst", ".bz2"})
    if (path.extension() == packing && path.stem().has_extension()) return path.stem().stem().string();
  return path.stem().string();
}

}  // namespace

std::vector<std::string> gridNames(const std::vector<fs::path>& inputs, const ConvertOptions& options) {
  std::vector<std::string> names = options.names;
  if (names.empty() && inputs.size() == 1) return {options.build.name};
  if (names.empty())
    for (const fs::path& input : inputs) names.push_back(stemOf(input));
  if (names.size() != inputs.size())
    throw OptionsError("options.names: expected one for each of " + std::to_string(inputs.size()) + " inputs, found " +
                       std::to_string(names.size()));
  std::map<std::string, fs::path> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto [first, isNew] = seen.emplace(names[i], inputs[i]);
    if (!isNew)
      throw OptionsError("grid names: expected different ones, found \"" + names[i] + "\" for both " +
                         first->second.string() + " and " + inputs[i].string() + "; give options.names to the inputs");
  }
  return names;
}

std::vector<std::string> gridUnits(std::size_t inputs, const std::vector<std::string>& given) {
  if (given.empty()) return std::vector<std::string>(inputs);
  if (given.size() == 1) return std::vector<std::string>(inputs, given.front());
  if (given.size() != inputs)
    throw OptionsError("options.units: expected one, or one for each of " + std::to_string(inputs) + " inputs, found " +
                       std::to_string(given.size()));
  return given;
}

void numberGrid(openvdb::GridBase& grid, std::int64_t number) {
  if (!grid["frame"]) grid.insertMeta("frame", openvdb::StringMetadata(std::to_string(number)));
}

}  // namespace umbrick
