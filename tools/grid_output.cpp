// SPDX-License-Identifier: Apache-2.0
#include "grid_output.h"

#include "command.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {

bool isDense(const fs::path& path) { return path.extension() == ".mhd" || path.extension() == ".nrrd"; }

// The file beside a .mhd.
fs::path voxelsOf(fs::path path) { return path.replace_extension(".raw"); }

NanoOptions nanoOptions(const GridOutput& output) {
  NanoOptions options;
  options.values = output.quantise == "4"    ? NanoValues::bits4
                   : output.quantise == "8"  ? NanoValues::bits8
                   : output.quantise == "16" ? NanoValues::bits16
                   : output.quantise == "n"  ? NanoValues::adaptive
                                             : NanoValues::float32;
  options.maxError = output.quantiseError;
  return options;
}

}  // namespace

VdbCodec codecOf(const GridOutput& output) {
  return output.codec == "zip" ? VdbCodec::zip : output.codec == "none" ? VdbCodec::none : VdbCodec::blosc;
}

void checkOutput(const GridOutput& output, const std::vector<fs::path>& inputs) {
  const fs::path& path = output.path;
  if (path.extension() != ".vdb" && path.extension() != ".nvdb" && !isDense(path))
    throw UsageError(path.string() + ": expected an output file that ends in .vdb, .nvdb, .mhd or .nrrd");
  if (!output.codec.empty() && path.extension() != ".vdb")
    throw UsageError(path.string() + ": --codec is for .vdb, not for " + path.extension().string());
  if (!output.quantise.empty() && path.extension() != ".nvdb")
    throw UsageError(path.string() + ": --quantise is for .nvdb, not for " + path.extension().string());
  if (isDense(path) && inputs.size() > 1)
    throw UsageError(path.string() + ": expected one input for " + path.extension().string() + ", found " +
                     std::to_string(inputs.size()));
  std::error_code missing;
  for (const fs::path& input : inputs) {
    const bool voxels = path.extension() == ".mhd" && fs::equivalent(input, voxelsOf(path), missing);
    if (voxels || (isDense(path) && fs::equivalent(input, path, missing)))
      throw UsageError(path.string() +
                       ": expected another name than that of the input, which would be overwritten, found " +
                       input.string());
  }
}

std::int64_t writeOutput(const GridOutput& output, const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                         openvdb::MetaMap metadata, std::optional<VoxelType> type, const NanoCheck& check) {
  const fs::path& path = output.path;
  const WrittenCheck exact = [&](const fs::path& written) { check(written, {}); };
  if (isDense(path)) {
    if (grids.size() != 1)
      throw UsageError(path.string() + ": expected one grid for " + path.extension().string() + ", found " +
                       std::to_string(grids.size()));
    DenseOptions dense;
    dense.type = type;
    writeDense(path, *grids.front(), dense, exact);
  } else if (path.extension() == ".nvdb") {
    writeNanoVdb(path, grids, nanoOptions(output), check);
  } else {
    if (!metadata["creator"]) metadata.insertMeta("creator", openvdb::StringMetadata("umbrick " UMBRICK_VERSION));
    writeGrids(path, grids, metadata, codecOf(output), exact);
  }
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
  return path.extension() == ".mhd" ? bytes + static_cast<std::int64_t>(fs::file_size(voxelsOf(path))) : bytes;
}

}  // namespace umbrick::tools
