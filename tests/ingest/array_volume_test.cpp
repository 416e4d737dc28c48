// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/array_volume.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <tuple>
#include <vector>

#include "support/complaint.h"
#include "support/read_volume.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

constexpr glm::i64vec3 kArrayDims(5, 4, 3);

// The numbers 0, 1, 2, ... by x, then y, then z, whatever the order of the axes in memory.
struct CountedArray {
  std::vector<float> memory;
  ArrayVolume array;

  // @param apart  numbers from a voxel to its neighbour along x, y, z  @param first  place of voxel (0, 0, 0)
  CountedArray(const glm::i64vec3& apart, std::int64_t first, std::size_t size) : memory(size, -1) {
    for (std::int64_t z = 0; z < kArrayDims.z; ++z)
      for (std::int64_t y = 0; y < kArrayDims.y; ++y)
        for (std::int64_t x = 0; x < kArrayDims.x; ++x)
          memory[static_cast<std::size_t>(first + x * apart.x + y * apart.y + z * apart.z)] =
              static_cast<float>(x + kArrayDims.x * (y + kArrayDims.y * z));
    array.data = reinterpret_cast<const std::byte*>(memory.data() + first);
    array.dims = kArrayDims;
    array.strides = apart * std::int64_t(sizeof(float));
  }
};

std::vector<float> counted() {
  std::vector<float> numbers(60);
  std::iota(numbers.begin(), numbers.end(), 0.0f);
  return numbers;
}

}  // namespace

TEST_CASE("Arrays of any order are read where they lie", "[ingest]") {
  for (const auto& [apart, first, size] :
       {std::tuple(glm::i64vec3(1, 5, 20), 0, 60), std::tuple(glm::i64vec3(12, 3, 1), 0, 60),
        std::tuple(glm::i64vec3(3, 15, 1), 0, 60), std::tuple(glm::i64vec3(-12, 3, -1), 50, 60),
        std::tuple(glm::i64vec3(2, 17, 71), 5, 300)}) {
    const CountedArray given(apart, first, static_cast<std::size_t>(size));
    CHECK(readVolume(*openArray(given.array, "array")) == counted());
    // Slices that are skipped are as if they had been read.
    const auto source = openArray(given.array, "array");
    source->skipSlices(2);
    std::vector<float> last(20);
    source->readSlab(1, last);
    const std::vector<float> all = counted();
    CHECK(last == std::vector<float>(all.begin() + 40, all.end()));
  }
}

TEST_CASE("Components of an array are read alone or as the length of a vector", "[ingest]") {
  // Component-major: all of x, then all of y.
  const std::vector<std::int16_t> memory{3, 5, 8, 4, 12, 15};
  ArrayVolume array;
  array.data = reinterpret_cast<const std::byte*>(memory.data());
  array.dims = {3, 1, 1};
  array.strides = {2, 6, 6};
  array.type = VoxelType::i16;
  array.components = 2;
  array.componentStride = 6;
  CHECK(readVolume(*openArray(array, "array", {.component = 1})) == std::vector<float>{4, 12, 15});
  CHECK(readVolume(*openArray(array, "array", {.magnitude = true})) == std::vector<float>{5, 13, 17});
  CHECK_THROWS_AS(openArray(array, "array"), SeveralParts);
}

TEST_CASE("An array lies where its matrix or the spacing says", "[ingest]") {
  const CountedArray given({1, 5, 20}, 0, 60);
  OpenOptions options;
  options.array = given.array;
  options.spacing = glm::dvec3(1, 2, 3);
  options.origin = glm::dvec3(7, 8, 9);
  const glm::dmat4 placed = openVolume("array", options)->info().indexToWorld;
  CHECK(placed == glm::dmat4(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 7, 8, 9, 1));
  options.lengthUnit = "cm";
  options.space = "RAS";
  const VolumeInfo info = openVolume("array", options)->info();
  CHECK(info.indexToWorld == placed);
  CHECK(info.metadata.at("length_unit") == "cm");
  CHECK(info.metadata.at("space") == "RAS");
  CHECK(info.notes.empty());
  options.array->indexToWorld = placed;
  CHECK_THAT(complaint<StatedPlace>([&] { openVolume("array", options); }), Contains("affine"));
  options.spacing.reset();
  options.origin.reset();
  CHECK(openVolume("array", options)->info().indexToWorld == placed);
}

TEST_CASE("Arrays that are no volume are refused", "[ingest]") {
  CountedArray given({1, 5, 20}, 0, 60);
  given.array.indexToWorld = glm::dmat4(0);
  CHECK_THAT(complaint<InvalidArgument>([&] { openArray(given.array, "a"); }), Contains("affine"));
  given.array.indexToWorld = glm::dmat4(1);
  (*given.array.indexToWorld)[1] = glm::dvec4(0);
  CHECK_THAT(complaint<InvalidArgument>([&] { openArray(given.array, "a"); }), Contains("determinant 0"));
  given.array.indexToWorld.reset();
  given.array.dims.y = 0;
  CHECK_THAT(complaint<InvalidArgument>([&] { openArray(given.array, "a"); }), Contains("5 x 0 x 3"));
}
