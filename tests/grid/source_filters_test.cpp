// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/source_filters.h"

#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "support/files.h"
#include "support/memory_source.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/ingest/raw_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

std::unique_ptr<MemorySource> numbered(const glm::i64vec3& dims) {
  std::vector<float> voxels(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  std::iota(voxels.begin(), voxels.end(), 1.0f);
  return std::make_unique<MemorySource>(dims, std::move(voxels));
}

}  // namespace

TEST_CASE("A cropped volume has the voxels of the box, at the places where they were", "[grid]") {
  const glm::i64vec3 dims(5, 6, 7);
  const glm::dmat4 matrix(0.5, 0.1, 0, 0, -0.2, 0.6, 0, 0, 0.05, 0, -1.5, 0, 10, -20, 3, 1);
  auto source = numbered(dims);
  source->editInfo().indexToWorld = matrix;
  const auto cropped = cropSource(std::move(source), {{1, 2, 3}, {4, 2, 5}});
  const glm::i64vec3 size = cropped->info().dims;
  CHECK(size == glm::i64vec3(4, 1, 3));
  std::vector<float> voxels(12);
  cropped->readSlab(1, std::span(voxels).first(4));
  cropped->readSlab(2, std::span(voxels).subspan(4));
  for (int z = 0; z < 3; ++z)
    for (int x = 0; x < 4; ++x) {
      CHECK(voxels[static_cast<std::size_t>(4 * z + x)] == float(1 + (x + 1) + 5 * 2 + 30 * (z + 3)));
      const glm::dvec4 here = cropped->info().indexToWorld * glm::dvec4(x, 0, z, 1);
      CHECK(glm::distance(here, matrix * glm::dvec4(x + 1, 2, z + 3, 1)) < 1e-14);  // a few roundings near 20
    }
  for (const IndexBox& box : {IndexBox{{0, 0, 0}, {5, 0, 0}}, IndexBox{{-1, 0, 0}, {2, 2, 2}}, IndexBox{}})
    CHECK_THROWS_WITH(cropSource(numbered(dims), box), Contains("inside (0 0 0) to (4 5 6), found ("));
}

// A part of a file that is not needed is not read, and a file that is too short is still found out.
TEST_CASE("Slices of files are skipped as if they had been read", "[grid]") {
  const TemporaryFolder folder;
  std::string bytes(64, '\0');
  std::iota(bytes.begin(), bytes.end(), '\0');
  writeBytes(folder.path() / "v.raw", bytes);
  const auto source = openRaw(folder.path() / "v.raw", {{4, 4, 4}, VoxelType::u8});
  CHECK(source->skipsFast());
  std::vector<float> slice(16);
  source->skipSlices(2);
  source->readSlab(1, slice);
  CHECK(slice[5] == 37);
  source->skipSlices(1);
  const auto cropped = cropSource(openRaw(folder.path() / "v.raw", {{4, 4, 4}, VoxelType::u8}), {{1, 1, 1}, {1, 1, 2}});
  cropped->readSlab(2, std::span(slice).first(2));
  CHECK(slice[0] == 21);
  CHECK(slice[1] == 37);
}

TEST_CASE("A masked volume has background where the mask is 0", "[grid]") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::uint64_t leftOut = 99;
  const auto masked = maskSource(
      std::make_unique<MemorySource>(glm::i64vec3(6, 1, 1), std::vector<float>{1, 2, 3, 7, 5, 6}),
      std::make_unique<MemorySource>(glm::i64vec3(6, 1, 1), std::vector<float>{1, 0, -1, 0, nan, 0}), 7, &leftOut);
  const BuiltGrid built = buildGrid(*masked, {"m", 7.0f});
  CHECK(built.report.activeVoxels == 3);
  CHECK(leftOut == 2);  // one was background already
  CHECK(built.grid->tree().getValue({1, 0, 0}) == 7);
  CHECK(built.grid->tree().getValue({4, 0, 0}) == 5);
}

TEST_CASE("A mask of another size or place is refused, and the message has both", "[grid]") {
  const glm::i64vec3 dims(4, 3, 2);
  CHECK_THROWS_WITH(maskSource(numbered(dims), numbered({4, 3, 3}), 0),
                    Contains("dims: expected 4 x 3 x 2 as in memory, found 4 x 3 x 3"));
  auto shifted = numbered(dims);
  shifted->editInfo().indexToWorld[3][1] = 0.01;
  CHECK_THROWS_WITH(maskSource(numbered(dims), std::move(shifted), 0),
                    Contains("expected (0 0 0) as in memory, found (0 0.01 0)"));
  auto rounded = numbered(dims);
  rounded->editInfo().indexToWorld[3][1] = 1e-6;  // headers hold few digits
  CHECK_NOTHROW(maskSource(numbered(dims), std::move(rounded), 0));
}

TEST_CASE("The border's most frequent value is that of the six faces, and the inside does not count", "[grid]") {
  const glm::i64vec3 dims(6, 5, 4);
  std::vector<float> voxels(120, 3);
  int faces = 0;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 6; ++x)
        if (x == 0 || x == 5 || y == 0 || y == 4 || z == 0 || z == 3)
          voxels[static_cast<std::size_t>((z * 5 + y) * 6 + x)] = ++faces % 3 == 0 ? float(faces) : -1000.0f;
  voxels[0] = std::numeric_limits<float>::quiet_NaN();
  MemorySource source(dims, voxels);
  const BorderMode mode = borderMode(source);
  CHECK(mode.value == -1000);
  CHECK(mode.border == 95);  // 120, less 4 * 3 * 2 inside and the one that is NaN
  CHECK(mode.voxels == 63);  // 64 (two of three of 96), less the one that is NaN
  const auto all = numbered(dims);
  CHECK_THROWS_WITH(borderMode(*all), Contains("found 96 different ones in 96 finite voxels"));
}

TEST_CASE("Only values inside the clip range stay", "[grid]") {
  MemorySource source({6, 1, 1}, {0, 1, 2, 3, 4, 5});
  BuildOptions options;
  options.clipBelow = 2.0f;
  options.clipAbove = 4.0f;
  const BuiltGrid built = buildGrid(source, options);
  CHECK(built.report.activeVoxels == 3);
  CHECK(built.report.clippedVoxels == 2);  // 0 is background
  CHECK(built.report.maxClipChange == 5);
  CHECK(built.grid->tree().getValue({4, 0, 0}) == 4);
}
