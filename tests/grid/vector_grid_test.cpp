// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/vector_grid.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "support/memory_source.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Larger than a leaf along each axis, and no multiple of one.
const glm::i64vec3 kVectorDims(19, 11, 21);

MemorySource vectorSource(std::vector<float> numbers) {
  MemorySource source(kVectorDims, std::move(numbers));
  source.editInfo().components = source.editInfo().valuesPerVoxel = 3;
  source.editInfo().meaning = VoxelMeaning::vector;
  return source;
}

// Vectors in a ball, with zeros around.
std::vector<float> ballOfVectors() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> number(-1, 1);
  std::vector<float> out;
  for (std::int64_t z = 0; z < kVectorDims.z; ++z)
    for (std::int64_t y = 0; y < kVectorDims.y; ++y)
      for (std::int64_t x = 0; x < kVectorDims.x; ++x) {
        const bool inside = (x - 9) * (x - 9) + (y - 5) * (y - 5) + (z - 10) * (z - 10) < 30;
        for (int k = 0; k < 3; ++k) out.push_back(inside ? number(random) : 0);
      }
  return out;
}

openvdb::Vec3f vectorAt(const std::vector<float>& numbers, const openvdb::Coord& at) {
  const auto i = static_cast<std::size_t>(3 * ((at.z() * kVectorDims.y + at.y()) * kVectorDims.x + at.x()));
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}

}  // namespace

TEST_CASE("A grid of vec3 holds the vectors of its volume, and what is left out is as far off as stated", "[grid]") {
  const std::vector<float> numbers = ballOfVectors();
  for (const float tolerance : {0.0f, 0.4f}) {
    MemorySource source = vectorSource(numbers), again = vectorSource(numbers);
    BuildOptions options;
    options.name = "v";
    options.tolerance = tolerance;
    const BuiltVectors built = buildVectorGrid(source, options);
    std::uint64_t active = 0;
    double largest = 0, squares = 0;
    const auto access = built.grid->getConstAccessor();
    for (int z = 0; z < kVectorDims.z; ++z)
      for (int y = 0; y < kVectorDims.y; ++y)
        for (int x = 0; x < kVectorDims.x; ++x) {
          const openvdb::Vec3f value = vectorAt(numbers, {x, y, z}), found = access.getValue({x, y, z});
          const bool kept =
              std::abs(value[0]) > tolerance || std::abs(value[1]) > tolerance || std::abs(value[2]) > tolerance;
          active += kept;
          if (kept != access.isValueOn({x, y, z})) FAIL("voxel " << x << ' ' << y << ' ' << z);
          for (int k = 0; k < 3; ++k) {
            const double error = std::abs(double(value[k]) - double(found[k]));
            largest = std::max(largest, error);
            squares += error * error;
          }
        }
    CHECK(built.report.activeVoxels == active);
    CHECK(built.grid->activeVoxelCount() == active);
    CHECK(built.report.maxError == largest);
    CHECK(largest <= tolerance);
    CHECK(built.report.rmsError == Approx(std::sqrt(squares / double(numbers.size()))));
    CHECK(verifyVectorGrid(again, *built.grid, options).honours(built.report));
  }
}

TEST_CASE("A comparison of vectors finds a number that differs and a voxel too many", "[grid]") {
  const std::vector<float> numbers = ballOfVectors();
  MemorySource source = vectorSource(numbers), first = vectorSource(numbers), second = vectorSource(numbers);
  const BuiltVectors built = buildVectorGrid(source);
  const auto changed = built.grid->deepCopy();
  changed->tree().setValueOnly({9, 5, 10}, changed->tree().getValue({9, 5, 10}) + openvdb::Vec3f(0, 0, 0.25f));
  CHECK(verifyVectorGrid(first, *changed, {}).error.max == Approx(0.25));
  const auto more = built.grid->deepCopy();
  more->tree().setValue({40, 0, 0}, openvdb::Vec3f(1));
  const VerifyReport beyond = verifyVectorGrid(second, *more, {});
  CHECK(beyond.beyond == 1);
  CHECK_FALSE(beyond.honours(built.report));
}

TEST_CASE("Integer colours become 0 to 1, vectors turn by their frame, and what is not finite is background",
          "[grid]") {
  std::vector<float> numbers(static_cast<std::size_t>(3 * kVectorDims.x * kVectorDims.y * kVectorDims.z), 0.0f);
  numbers[0] = 255, numbers[1] = 51;
  MemorySource colours = vectorSource(numbers);
  colours.editInfo().meaning = VoxelMeaning::colour;
  colours.editInfo().type = VoxelType::u8;
  CHECK(buildVectorGrid(colours).grid->tree().getValue({0, 0, 0}) == openvdb::Vec3f(1, 0.2f, 0));

  numbers[0] = 1, numbers[1] = 2, numbers[2] = 3;
  numbers[4] = std::numeric_limits<float>::quiet_NaN();
  MemorySource vectors = vectorSource(numbers), again = vectorSource(numbers);
  // x to y, y to -x
  vectors.editInfo().vectorToWorld = again.editInfo().vectorToWorld = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
  const BuiltVectors built = buildVectorGrid(vectors);
  CHECK(built.grid->tree().getValue({0, 0, 0}) == openvdb::Vec3f(-2, 1, 3));
  CHECK_FALSE(built.grid->tree().isValueOn({1, 0, 0}));
  CHECK(built.report.nonFinite == 1);
  CHECK(verifyVectorGrid(again, *built.grid, {}).honours(built.report));
}
