// SPDX-License-Identifier: Apache-2.0
#include "convert/write_output.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "umbrick/convert/options_error.h"
#include "umbrick/core/output.h"
#include "umbrick/grid/grid_world.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// The format of an output, as an extension.
std::string formatOf(const fs::path& path, const OutputOptions& options) {
  const std::string extension = path.extension().string();
  for (const char* known : {".vdb", ".nvdb", ".mhd", ".nrrd"})
    if (extension == known) return extension;
  return options.format;
}

bool isDense(const std::string& format) { return format == ".mhd" || format == ".nrrd"; }

// A pair of files has two places, of which a stream is one.
void checkPair(const fs::path& path) {
  if (outputAt(path).isStream())
    throw OptionsError(path.string() +
                       ": a .mhd is a header and a file of voxels, which one stream cannot hold; "
                       "output.format .nrrd has both in one");
  voxelFileOf(path);
}

// A .nvdb has no metadata but the names of its grids.
void tellLostWorld(const openvdb::FloatGrid& grid, std::vector<std::string>& notes) {
  const World world = worldOf(grid);
  if (world.space.empty() && world.lengthUnit.empty()) return;
  notes.push_back("NanoVDB has no place for metadata: the file does not say that its world is " + world.space +
                  (world.space.empty() || world.lengthUnit.empty() ? "" : " and ") +
                  (world.lengthUnit.empty() ? "" : "in " + world.lengthUnit));
}

// The grids as formats want them that hold no others. @throw OptionsError  one is no grid of floats
std::vector<openvdb::FloatGrid::ConstPtr> floatGrids(const fs::path& path, const OutputOptions& output,
                                                     const openvdb::GridCPtrVec& grids) {
  std::vector<openvdb::FloatGrid::ConstPtr> out;
  for (const auto& grid : grids)
    if (out.push_back(openvdb::gridConstPtrCast<openvdb::FloatGrid>(grid)); !out.back()) refuseVectors(path, output);
  return out;
}

}  // namespace

void refuseVectors(const fs::path& path, const OutputOptions& output) {
  if (formatOf(path, output) != ".vdb")
    throw OptionsError(path.string() +
                       ": expected a .vdb for a grid of vec3; of its numbers one is chosen by "
                       "source.open.parts.component, and options.eachComponent makes a grid of each");
}

void checkOutput(const fs::path& path, const OutputOptions& options, const std::vector<fs::path>& inputs) {
  const std::string format = formatOf(path, options);
  if (format.empty())
    throw OptionsError(path.string() + ": expected an output file that ends in .vdb, .nvdb, .mhd or .nrrd");
  if (options.codec && format != ".vdb")
    throw OptionsError(path.string() + ": output.codec is for .vdb, not for " + format);
  if (options.nano && format != ".nvdb")
    throw OptionsError(path.string() + ": output.nano is for .nvdb, not for " + format);
  if (options.target && format != ".vdb")
    throw OptionsError(path.string() + ": output.target is for .vdb, not for " + format);
  if (isDense(format) && inputs.size() > 1)
    throw OptionsError(path.string() + ": expected one input for " + format + ", found " +
                       std::to_string(inputs.size()));
  if (format == ".mhd") checkPair(path);
  std::error_code missing;
  for (const fs::path& input : inputs) {
    const bool voxels = format == ".mhd" && fs::equivalent(input, voxelFileOf(path), missing);
    if (voxels || (isDense(format) && fs::equivalent(input, path, missing)))
      throw OptionsError(path.string() +
                         ": expected another name than that of the input, which would be overwritten, found " +
                         input.string());
  }
}

void checkGridCount(const fs::path& path, const OutputOptions& options, const std::vector<std::string>& labels) {
  const std::string format = formatOf(path, options);
  if (!isDense(format) || labels.size() == 1) return;
  constexpr std::size_t kMostNamed = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(labels.size(), kMostNamed); ++i)
    names += (i == 0 ? "\"" : ", \"") + labels[i] + '"';
  throw OptionsError(path.string() + ": expected one grid for " + format + ", found " + std::to_string(labels.size()) +
                     "; name one with options.grids: " + names + (labels.size() > kMostNamed ? ", ..." : ""));
}

std::int64_t writeOutput(const fs::path& path, const OutputOptions& output, const openvdb::GridCPtrVec& grids,
                         openvdb::MetaMap metadata, std::optional<VoxelType> type, const NanoCheck& check,
                         std::vector<std::string>& notes) {
  const std::string format = formatOf(path, output);
  std::int64_t bytes = 0;  // of a stream nobody knows them later
  const NanoCheck counted = [&](const fs::path& written, const std::vector<QuantiseError>& errors) {
    bytes = static_cast<std::int64_t>(fs::file_size(written));
    check(written, errors);
  };
  const WrittenCheck exact = [&](const fs::path& written) { counted(written, {}); };
  if (isDense(format)) {
    std::vector<std::string> labels;
    for (const auto& grid : grids) labels.push_back(grid->getName());
    checkGridCount(path, output, labels);
    DenseOptions dense;
    dense.type = type;
    dense.nrrd = format == ".nrrd";
    const openvdb::FloatGrid::ConstPtr first = floatGrids(path, output, grids).front();
    const openvdb::FloatGrid& values = *first;
    const DenseBox box = writeDense(path, values, dense, exact);
    const std::string space = worldOf(values).space;
    if (box.space != space)
      notes.push_back("the place is written in " + box.space + ", as " + format +
                      " has it; the world of the input is " + space);
  } else if (format == ".nvdb") {
    writeNanoVdb(path, floatGrids(path, output, grids), output.nano.value_or(NanoOptions{}), counted);
    tellLostWorld(*floatGrids(path, output, grids).front(), notes);
  } else {
    if (!metadata["creator"]) metadata.insertMeta("creator", openvdb::StringMetadata(output.creator));
    writeAnyGrids(path, grids, metadata, output.codec.value_or(VdbCodec::blosc), exact);
  }
  if (format != ".mhd") return bytes;
  return static_cast<std::int64_t>(fs::file_size(path)) + static_cast<std::int64_t>(fs::file_size(voxelFileOf(path)));
}

}  // namespace umbrick
