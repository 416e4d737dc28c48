// Grids in memory are those of the files that conversions write, and become such files.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/load_volume.h"

#include <catch2/catch.hpp>
#include <vector>

#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/dense_values.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/summary.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Voxels from 1 to 60 in memory, x fastest.
struct MemoryInput {
  std::vector<std::uint8_t> voxels;
  ConvertOptions options;

  MemoryInput() : voxels(60) {
    for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<std::uint8_t>(i + 1);
    ArrayVolume array;
    array.data = reinterpret_cast<const std::byte*>(voxels.data());
    array.dims = {5, 4, 3};
    array.strides = {1, 5, 20};
    array.type = VoxelType::u8;
    options.source.open.array = array;
    options.source.open.spacing = glm::dvec3(1, 2, 3);
  }
};

constexpr IndexBox kLoadedBox{{-1, -1, -1}, {5, 4, 3}};  // one voxel beyond all sides

std::vector<float> loadedValues(const ScalarGrid& grid) {
  const glm::i64vec3 extent = kLoadedBox.extent();
  std::vector<float> out(static_cast<std::size_t>(extent.x * extent.y * extent.z));
  copyValues(grid, kLoadedBox, out);
  return out;
}

}  // namespace

TEST_CASE("A conversion in memory makes the grid that the file has", "[convert]") {
  const TemporaryFolder folder;
  MemoryInput input;
  input.options.build.clipBelow = 20.0f;
  input.options.names = {"pressure"};
  input.options.units = {"Pa"};
  const auto path = folder.path() / "a.vdb";
  const ConvertReport report = convertVolumes({"array"}, path, input.options);
  const LoadedVolume loaded = convertInMemory("array", input.options);
  const ScalarGrid file = readScalarGrid(path);
  CHECK(loadedValues(loaded.grid) == loadedValues(file));
  CHECK(loaded.grid.grid->transform() == file.grid->transform());
  CHECK(loaded.grid.name == "pressure");
  CHECK(loaded.grid.metadata("value_unit") == "Pa");
  CHECK(loaded.report.build.clippedVoxels == report.grids.front().build.clippedVoxels);
  // A grid of a file is converted by the same rules.
  ConvertOptions again;
  again.build.tolerance = 5;
  const auto other = folder.path() / "b.vdb";
  convert({path}, other, again);
  CHECK(loadedValues(convertInMemory(path, again).grid) == loadedValues(readScalarGrid(other)));
}

TEST_CASE("A grid in memory is saved as a conversion would write it", "[convert]") {
  const TemporaryFolder folder;
  const MemoryInput input;
  const LoadedVolume loaded = convertInMemory("array", input.options);
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const SavedGrid saved = saveGrid(loaded.grid, folder.path() / name, {}, VoxelType::u8);
    CHECK(saved.bytes == static_cast<std::int64_t>(std::filesystem::file_size(folder.path() / name)));
    CHECK(loadedValues(readScalarGrid(folder.path() / name)) == loadedValues(loaded.grid));
  }
  const GridSummary memory = summariseGrid(loaded.grid), file = summariseFile(folder.path() / "a.vdb").grids.front();
  CHECK(memory.activeVoxels == 60);
  CHECK(memory.activeBox == file.activeBox);
  CHECK(memory.indexToWorld == file.indexToWorld);
  CHECK(memory.values->histogram == file.values->histogram);
  CHECK_THAT(complaint<OptionsError>([&] { saveGrid(loaded.grid, folder.path() / "a.txt"); }), Contains("a.txt"));
}

TEST_CASE("Values of a box are copied with x fastest and the background beyond", "[convert]") {
  const LoadedVolume loaded = convertInMemory("array", MemoryInput().options);
  std::vector<float> out(2 * 2 * 2);
  copyValues(loaded.grid, {{4, 3, 1}, {5, 4, 2}}, out);
  CHECK(out == std::vector<float>{40, 0, 0, 0, 60, 0, 0, 0});
  CHECK_THROWS_AS(copyValues(loaded.grid, {{4, 3, 1}, {4, 4, 2}}, out), InvalidArgument);
  CHECK_THROWS_AS(copyValues(loaded.grid, {}, std::span<float>()), InvalidArgument);
}
