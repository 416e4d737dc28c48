// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <map>

#include "fuzz/readers.h"
#include "support/files.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick::fuzz {
namespace {

// Leaves, a tile and a background; in the format that the extension says.
std::string goodFile(const std::filesystem::path& path) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(0.5f);
  grid->setName("density");
  grid->insertMeta("note", openvdb::StringMetadata("text"));
  for (int i = 0; i < 24; ++i) grid->tree().setValue({i, 3 * i % 7, 5}, static_cast<float>(i));
  grid->tree().addTile(1, {0, 64, 0}, 2, true);
  if (path.extension() == ".vdb") {
    writeGrids(path, {grid}, {}, VdbCodec::none);
  } else {
    NanoOptions options;
    options.values = NanoValues::adaptive;
    options.maxError = 0.1f;
    writeNanoVdb(path, {grid}, options);
  }
  return readBytes(path);
}

void patchedGrid(const std::filesystem::path& path, std::string_view changes) {
  static std::map<std::string, std::string> good;
  std::string& bytes = good[path.extension().string()];
  if (bytes.empty()) bytes = goodFile(path);
  writeBytes(path, patched(bytes, changes));
  readScalarGrid(path);
}

}  // namespace

std::map<std::string, NamedTarget> gridTargets() {
  return {{"nvdb", {".nvdb", patchedGrid}}, {"vdb", {".vdb", patchedGrid}}};
}

}  // namespace umbrick::fuzz
