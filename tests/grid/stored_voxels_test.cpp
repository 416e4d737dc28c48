// Voxels are made sparse as they are stored; the floats that they stand for must give the same grid.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "support/files.h"
#include "support/memory_source.h"
#include "support/temporary_folder.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/ingest/raw_volume.h"

using namespace umbrick;

namespace {

const glm::i64vec3 kDims(35, 19, 21);  // no multiples of 8, and more than one leaf along each axis

// A volume with boxes of one value and of noise in a constant background.
template <class T>
std::vector<T> boxes(T background) {
  std::mt19937 random(11);
  std::vector<T> voxels;
  for (int z = 0; z < kDims.z; ++z)
    for (int y = 0; y < kDims.y; ++y)
      for (int x = 0; x < kDims.x; ++x) {
        const bool noisy = x > 4 && x < 14 && y > 9 && z > 12, constant = x >= 16 && x < 24 && y < 8 && z < 8;
        const bool last = x == kDims.x - 1 && y == kDims.y - 1 && z == kDims.z - 1;
        voxels.push_back(noisy ? static_cast<T>(random() % 100) : constant || last ? T(77) : background);
      }
  return voxels;
}

void checkSame(VoxelSource& stored, const std::vector<float>& floats, const BuildOptions& options) {
  MemorySource memory(kDims, floats);
  const BuiltGrid a = buildGrid(stored, options), b = buildGrid(memory, options);
  CHECK(a.report.activeVoxels > 0);
  CHECK(a.grid->tree().hasSameTopology(b.grid->tree()));
  CHECK(a.report.maxError == b.report.maxError);
  CHECK(a.report.rmsError == b.report.rmsError);
  CHECK(a.report.clippedVoxels == b.report.clippedVoxels);
  std::size_t different = 0;
  for (auto value = a.grid->cbeginValueAll(); value; ++value)
    different += *value != b.grid->tree().getValue(value.getCoord());
  CHECK(different == 0);
}

template <class T>
void checkType(VoxelType type, T fill, float background, bool reversed) {
  CAPTURE(voxelTypeName(type), fill, background, reversed);
  const TemporaryFolder folder;
  const std::vector<T> voxels = boxes(fill);
  writeBytes(folder.path() / "v.raw", bytesOf(voxels, reversed));
  RawOptions raw;
  raw.dims = kDims;
  raw.type = type;
  raw.endian = reversed ? std::endian::big : std::endian::little;
  BuildOptions plain, lossy;
  plain.background = lossy.background = background;
  lossy.tolerance = 3;
  lossy.clipAbove = 90.0f;
  for (const BuildOptions& options : {plain, lossy})
    checkSame(*openRaw(folder.path() / "v.raw", raw), {voxels.begin(), voxels.end()}, options);
}

}  // namespace

// The backgrounds are the one in the file, another, one between two integers, and one that no integer of
// 16 bits reaches.
TEST_CASE("Stored voxels of every type give the grid of their floats", "[grid]") {
  for (const bool reversed : {false, true})
    for (const float background : {0.0f, 40.0f, 0.5f, 1e6f, -1e6f}) {
      checkType<std::uint8_t>(VoxelType::u8, 40, background, reversed);
      checkType<std::int8_t>(VoxelType::i8, 0, background, reversed);
      checkType<std::uint16_t>(VoxelType::u16, 40, background, reversed);
      checkType<std::int16_t>(VoxelType::i16, -1000, background, reversed);
      checkType<std::int32_t>(VoxelType::i32, 40, background, reversed);
      checkType<float>(VoxelType::f32, 0.5f, background, reversed);
      checkType<float>(VoxelType::f32, -0.0f, background, reversed);
      checkType<double>(VoxelType::f64, 40, background, reversed);
    }
}
