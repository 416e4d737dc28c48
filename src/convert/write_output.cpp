// SPDX-License-Identifier: Apache-2.0
#include "convert/write_output.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "umbrick/convert/options_error.h"
#include "umbrick/grid/grid_world.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

bool isDense(const fs::path& path) { return path.extension() == ".mhd" || path.extension() == ".nrrd"; }

// The file beside a .mhd.
fs::path voxelsOf(fs::path path) { return path.replace_extension(".raw"); }

// A .nvdb has no metadata but the names of its grids.
void tellLostWorld(const openvdb::FloatGrid& grid, std::vector<std::string>& notes) {
  const World world = worldOf(grid);
  if (world.space.empty() && world.lengthUnit.empty()) return;
  notes.push_back("NanoVDB has no place for metadata: the file does not say that its world is " + world.space +
                  (world.space.empty() || world.lengthUnit.empty() ? "" : " and ") +
                  (world.lengthUnit.empty() ? "" : "in " + world.lengthUnit));
}

// The grids as formats want them that hold no others. @throw OptionsError  one is no grid of floats
std::vector<openvdb::FloatGrid::ConstPtr> floatGrids(const fs::path& path, const openvdb::GridCPtrVec& grids) {
  std::vector<openvdb::FloatGrid::ConstPtr> out;
  for (const auto& grid : grids)
    if (out.push_back(openvdb::gridConstPtrCast<openvdb::FloatGrid>(grid)); !out.back()) refuseVectors(path);
  return out;
}

}  // namespace

void refuseVectors(const fs::path& path) {
  if (path.extension() != ".vdb")
    throw OptionsError(path.string() +
                       ": expected a .vdb for a grid of vec3; of its numbers one is chosen by "
                       "source.open.parts.component, and options.eachComponent makes a grid of each");
}

void checkOutput(const fs::path& path, const OutputOptions& options, const std::vector<fs::path>& inputs) {
  if (path.extension() != ".vdb" && path.extension() != ".nvdb" && !isDense(path))
    throw OptionsError(path.string() + ": expected an output file that ends in .vdb, .nvdb, .mhd or .nrrd");
  if (options.codec && path.extension() != ".vdb")
    throw OptionsError(path.string() + ": output.codec is for .vdb, not for " + path.extension().string());
  if (options.nano && path.extension() != ".nvdb")
    throw OptionsError(path.string() + ": output.nano is for .nvdb, not for " + path.extension().string());
  if (options.target && path.extension() != ".vdb")
    throw OptionsError(path.string() + ": output.target is for .vdb, not for " + path.extension().string());
  if (isDense(path) && inputs.size() > 1)
    throw OptionsError(path.string() + ": expected one input for " + path.extension().string() + ", found " +
                       std::to_string(inputs.size()));
  std::error_code missing;
  for (const fs::path& input : inputs) {
    const bool voxels = path.extension() == ".mhd" && fs::equivalent(input, voxelsOf(path), missing);
    if (voxels || (isDense(path) && fs::equivalent(input, path, missing)))
      throw OptionsError(path.string() +
                         ": expected another name than that of the input, which would be overwritten, found " +
                         input.string());
  }
}

void checkGridCount(const fs::path& path, const std::vector<std::string>& labels) {
  if (!isDense(path) || labels.size() == 1) return;
  constexpr std::size_t kMostNamed = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(labels.size(), kMostNamed); ++i)
    names += (i == 0 ? "\"" : ", \"") + labels[i] + '"';
  throw OptionsError(path.string() + ": expected one grid for " + path.extension().string() + ", found " +
                     std::to_string(labels.size()) + "; name one with options.grids: " + names +
                     (labels.size() > kMostNamed ? ", ..." : ""));
}

std::int64_t writeOutput(const fs::path& path, const OutputOptions& output, const openvdb::GridCPtrVec& grids,
                         openvdb::MetaMap metadata, std::optional<VoxelType> type, const NanoCheck& check,
                         std::vector<std::string>& notes) {
  const WrittenCheck exact = [&](const fs::path& written) { check(written, {}); };
  if (isDense(path)) {
    std::vector<std::string> labels;
    for (const auto& grid : grids) labels.push_back(grid->getName());
    checkGridCount(path, labels);
    DenseOptions dense;
    dense.type = type;
    const openvdb::FloatGrid::ConstPtr first = floatGrids(path, grids).front();
    const openvdb::FloatGrid& values = *first;
    const DenseBox box = writeDense(path, values, dense, exact);
    const std::string space = worldOf(values).space;
    if (box.space != space)
      notes.push_back("the place is written in " + box.space + ", as " + path.extension().string() +
                      " has it; the world of the input is " + space);
  } else if (path.extension() == ".nvdb") {
    writeNanoVdb(path, floatGrids(path, grids), output.nano.value_or(NanoOptions{}), check);
    tellLostWorld(*floatGrids(path, grids).front(), notes);
  } else {
    if (!metadata["creator"]) metadata.insertMeta("creator", openvdb::StringMetadata(output.creator));
    writeAnyGrids(path, grids, metadata, output.codec.value_or(VdbCodec::blosc), exact);
  }
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
  return path.extension() == ".mhd" ? bytes + static_cast<std::int64_t>(fs::file_size(voxelsOf(path))) : bytes;
}

}  // namespace umbrick
