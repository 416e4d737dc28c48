// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/resample.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "support/memory_source.h"
#include "support/read_volume.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/source_filters.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const glm::dmat4 kSheared(0.5, 0.1, 0, 0, -0.2, 0.6, 0, 0, 0.05, 0.3, -1.5, 0, 10, -20, 3, 1);

// Noise from -500 to 500, so that errors of a sum are not hidden by its size.
std::vector<float> noise(const glm::i64vec3& dims) {
  std::mt19937 random(5);
  std::vector<float> voxels(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (float& value : voxels) value = static_cast<float>(random() % 1001) - 500 + 0.25f * float(random() % 4);
  return voxels;
}

std::unique_ptr<MemorySource> source(const glm::i64vec3& dims, std::vector<float> voxels,
                                     const glm::dmat4& place = glm::dmat4(1)) {
  auto out = std::make_unique<MemorySource>(dims, std::move(voxels));
  out->editInfo().indexToWorld = place;
  return out;
}

struct Resampled {
  VolumeInfo info;
  std::vector<float> voxels;
  ResampleReport report;
};
Resampled resampled(std::unique_ptr<VoxelSource> from, const glm::dvec3& spacing) {
  const auto report = std::make_shared<ResampleReport>();
  const auto to = resampleSource(std::move(from), spacing, report);
  std::vector<float> voxels = readVolume(*to);
  return {to->info(), std::move(voxels), *report};
}

double overlap(double a0, double a1, double b0, double b1) {
  return std::max(std::min(a1, b1) - std::max(a0, b0), 0.0);
}

}  // namespace

TEST_CASE("Resampling to the same spacing changes no bit, also where headers round it", "[grid]") {
  const glm::i64vec3 dims(9, 7, 5);
  glm::dmat4 place = kSheared;
  const glm::dvec3 spacing(glm::length(glm::dvec3(place[0])), glm::length(glm::dvec3(place[1])),
                           glm::length(glm::dvec3(place[2])));
  for (const double rounded : {1.0, 1 + 1e-7}) {
    const Resampled out = resampled(source(dims, noise(dims), place), spacing * rounded);
    CHECK(out.info.dims == dims);
    CHECK(out.voxels == noise(dims));
    CHECK(out.report.max == 0);
    CHECK(out.report.rms == 0);
  }
}

TEST_CASE("Voxels twice as large have the mean of eight", "[grid]") {
  const glm::i64vec3 dims(8, 6, 4);
  const std::vector<float> voxels = noise(dims);
  const Resampled out = resampled(source(dims, voxels), glm::dvec3(2));
  REQUIRE(out.info.dims == glm::i64vec3(4, 3, 2));
  double squares = 0, largest = 0;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) {
        const auto at = [&](int i) {
          return double(voxels[std::size_t(((2 * z + i / 4) * 6 + 2 * y + i / 2 % 2) * 8 + 2 * x + i % 2)]);
        };
        double mean = 0;
        for (int i = 0; i < 8; ++i) mean += at(i) / 8;
        // Values are quarters, so sums are exact.
        CHECK(out.voxels[std::size_t((z * 3 + y) * 4 + x)] == static_cast<float>(mean));
        for (int i = 0; i < 8; ++i) {
          squares += (at(i) - mean) * (at(i) - mean);
          largest = std::max(largest, std::abs(at(i) - mean));
        }
      }
  // The 192 squares are added up in another order.
  CHECK(out.report.rms == Approx(std::sqrt(squares / double(voxels.size()))).epsilon(1e-12));
  CHECK(out.report.max == Approx(largest).epsilon(1e-7));  // the new value is rounded to float
}

TEST_CASE("Each new voxel has the mean of what it covers, for any spacing", "[grid]") {
  const glm::i64vec3 dims(7, 5, 6);
  const std::vector<float> voxels = noise(dims);
  for (const glm::dvec3& spacing : {glm::dvec3(1.7, 2.3, 1.1), glm::dvec3(0.4, 0.35, 0.9), glm::dvec3(50, 0.6, 3)}) {
    const Resampled out = resampled(source(dims, voxels), spacing);
    const glm::i64vec3 size = out.info.dims;
    REQUIRE(size == glm::i64vec3(glm::ceil(glm::dvec3(dims) / spacing)));
    for (std::int64_t i = 0; i < size.x * size.y * size.z; ++i) {
      const glm::dvec3 at(i % size.x, i / size.x % size.y, i / size.x / size.y);
      double sum = 0, volume = 0;
      for (std::int64_t j = 0; j < std::ssize(voxels); ++j) {
        const glm::dvec3 from(j % dims.x, j / dims.x % dims.y, j / dims.x / dims.y);
        double share = 1;
        for (int axis = 0; axis < 3; ++axis)
          share *= overlap(at[axis] * spacing[axis], (at[axis] + 1) * spacing[axis], from[axis], from[axis] + 1);
        sum += share * double(voxels[std::size_t(j)]);
        volume += share;
      }
      // The limit is a float's rounding of values up to 500, and one rounding of the boxes' edges.
      CHECK(std::abs(double(out.voxels[std::size_t(i)]) - sum / volume) < 5e-5);
    }
  }
}

TEST_CASE("The integral stays, and a constant stays constant, in any place and spacing", "[grid]") {
  const glm::i64vec3 dims(11, 6, 9);
  std::vector<float> voxels = noise(dims);
  for (float& value : voxels) value += 600;
  double sum = 0;
  for (const float value : voxels) sum += double(value);
  const double voxelVolume = std::abs(glm::determinant(glm::dmat3(kSheared)));
  for (const double spacing : {0.17, 0.31, 0.9, 2.6, 100.0}) {
    const Resampled out = resampled(source(dims, voxels, kSheared), glm::dvec3(spacing));
    CHECK(out.report.integralBefore == Approx(sum * voxelVolume).epsilon(1e-12));
    CHECK(out.report.integralAfter == Approx(sum * voxelVolume).epsilon(1e-6));
    const Resampled flat =
        resampled(source(dims, std::vector<float>(voxels.size(), 0.1f), kSheared), glm::dvec3(spacing));
    CHECK(flat.voxels == std::vector<float>(flat.voxels.size(), 0.1f));
    CHECK(flat.report.max == 0);
    CHECK(flat.report.rms == 0);
  }
}

TEST_CASE("Resampled volumes keep their axes and the faces where they start", "[grid]") {
  const glm::i64vec3 dims(10, 4, 6);
  const glm::dvec3 spacing(0.3, 2, 0.75);
  const Resampled out = resampled(source(dims, noise(dims), kSheared), spacing);
  const glm::dvec4 corner(-0.5, -0.5, -0.5, 1);
  CHECK(glm::distance(out.info.indexToWorld * corner, kSheared * corner) < 1e-13);  // a few roundings near 20
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 before(kSheared[axis]), after(out.info.indexToWorld[axis]);
    CHECK(glm::length(after) == Approx(spacing[axis]).epsilon(1e-14));
    CHECK(glm::dot(before, after) == Approx(glm::length(before) * glm::length(after)).epsilon(1e-14));
  }
  CHECK(out.info.type == VoxelType::f32);
}

TEST_CASE("Skipping slices of a resampled volume changes nothing of what is read", "[grid]") {
  const glm::i64vec3 dims(4, 3, 17);
  for (const double spacing : {0.4, 1.0, 2.3}) {
    const auto whole = resampled(source(dims, noise(dims)), {1, 1, spacing});
    const auto to = resampleSource(source(dims, noise(dims)), {1, 1, spacing});
    std::vector<float> slice(12);
    for (std::int64_t z = 0; z < to->info().dims.z; ++z) {
      if (z % 3 == 1) {
        to->skipSlices(1);
        continue;
      }
      to->readSlab(1, slice);
      CHECK(std::equal(slice.begin(), slice.end(), whole.voxels.begin() + 12 * z));
    }
  }
}

TEST_CASE("A value that is not finite makes new voxels so where they cover it, and nowhere else", "[grid]") {
  std::vector<float> voxels{1, 2, std::numeric_limits<float>::quiet_NaN(), 4, 5, 7};
  const Resampled out = resampled(source({6, 1, 1}, voxels), {2, 1, 1});
  CHECK(out.voxels[0] == 1.5f);
  CHECK(std::isnan(out.voxels[1]));
  CHECK(out.voxels[2] == 6);
  CHECK(out.report.max == 1);
  CHECK(out.report.integralBefore == 15);
}

TEST_CASE("Spacings that make no volume are refused", "[grid]") {
  const auto refused = [](const glm::dvec3& spacing, const char* message) {
    CHECK_THROWS_AS(resampleSource(source({4, 1, 1}, {1, 2, 3, 4}), spacing), InvalidArgument);
    CHECK_THROWS_WITH(resampleSource(source({4, 1, 1}, {1, 2, 3, 4}), spacing), Contains(message));
  };
  refused({1, 0, 1}, "memory: resample: expected a spacing > 0, found 0");
  refused({1, 1, std::numeric_limits<double>::infinity()}, "found inf");
  refused({1e-9, 1, 1}, "at most 2147483647 voxels along an axis, found 1e-09");
}

// A slice of the source is in memory, whatever the size of the result: here 2^48 voxels for 17 x 17.
TEST_CASE("Slices of the source beyond the memory are refused before anything is read", "[grid]") {
  const std::int64_t wide = std::int64_t(1) << 24;
  CHECK_THROWS_WITH(resampleSource(source({wide, wide, 1}, {}), glm::dvec3(1e6)),
                    Contains("memory: dims: two slabs of 16777216 x 16777216 x 1 voxels take"));
}
