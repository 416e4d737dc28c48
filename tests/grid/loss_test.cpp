// What is lost, stated, kept and checked.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "support/memory_source.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/verify.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
using Catch::Contains;
using openvdb::Coord;

namespace {

// A volume with noise around a wave, a flat region and empty space.
std::vector<float> noisyVolume(const glm::i64vec3& dims, float scale) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> noise(-0.05f, 0.05f);
  std::vector<float> voxels;
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x) {
        const float wave = std::sin(0.2f * float(x)) + std::cos(0.15f * float(y)) + 0.1f * float(z % 7);
        voxels.push_back(wave <= 0 ? 0.0f : scale * (x < 16 ? 1.0f + 0.1f * noise(random) : wave + noise(random)));
      }
  return voxels;
}

struct Plain {
  double max = 0, squares = 0, activeSquares = 0;
};

Plain difference(const openvdb::FloatGrid& grid, const glm::i64vec3& dims, const std::vector<float>& voxels) {
  Plain plain;
  const auto access = grid.getConstAccessor();
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto at = static_cast<std::int64_t>(i);
    float stored = 0;
    const bool on =
        access.probeValue(Coord(int(at % dims.x), int(at / dims.x % dims.y), int(at / dims.x / dims.y)), stored);
    const double error = std::abs(double(voxels[i]) - double(stored));
    plain.max = std::max(plain.max, error);
    plain.squares += error * error;
    if (on) plain.activeSquares += error * error;
  }
  return plain;
}

double number(const openvdb::FloatGrid& grid, const char* key) {
  const auto found = grid.getMetadata<openvdb::DoubleMetadata>(key);
  return found ? found->value() : 0;
}

}  // namespace

TEST_CASE("Maximum and RMS error of each lossy step are exact and kept in the file", "[grid]") {
  const glm::i64vec3 dims(43, 30, 21);
  const std::vector<float> voxels = noisyVolume(dims, 1);
  for (const float tolerance : {0.0f, 0.1f})
    for (const bool toHalf : {false, true})
      for (const float step : {0.0f, 0.0625f, 0.07f}) {
        CAPTURE(tolerance, toHalf, step);
        BuildOptions options;
        options.tolerance = tolerance;
        options.half = toHalf;
        options.step = step;
        MemorySource source(dims, voxels);
        const BuiltGrid built = buildGrid(source, options);
        const Plain plain = difference(*built.grid, dims, voxels);
        const BuildReport& report = built.report;
        // The squares are added up in another order; 1e-12 is thousands of roundings of the last bit.
        const auto rms = [](double squares, std::uint64_t n) {
          return Approx(std::sqrt(squares / double(n))).epsilon(1e-12).margin(1e-300);
        };
        CHECK(report.maxError == plain.max);
        CHECK(report.rmsError == rms(plain.squares, voxels.size()));
        CHECK(report.activeRmsError == rms(plain.activeSquares, report.activeVoxels));
        CHECK(report.maxError == std::max(report.tolerance.max, report.rounding.max));
        CHECK(report.rmsError == Approx(std::hypot(report.tolerance.rms, report.rounding.rms)).margin(1e-300));
        CHECK((report.tolerance.max > 0) == (tolerance > 0));
        CHECK((report.rounding.max > 0) == (toHalf || step > 0));
        if (step > 0 && !toHalf) CHECK(report.rounding.max <= step / 2 * (1 + 1e-6));  // and a float's rounding

        const TemporaryFolder folder;
        writeGrids(folder.path() / "v.vdb", {built.grid});
        const ScalarGrid back = readScalarGrid(folder.path() / "v.vdb");
        CHECK(number(*back.grid, "error_max") == report.maxError);
        CHECK(number(*back.grid, "error_rms") == report.rmsError);
        CHECK(number(*back.grid, "error_rms_rounding") == report.rounding.rms);
        CHECK(back.grid->metaValue<std::string>("storage") == report.storage);
        MemorySource again(dims, voxels);
        const VerifyReport seen = verifyGrid(again, *back.grid, options);
        CHECK(seen.error.max == report.maxError);
        CHECK(seen.error.rms == Approx(report.rmsError).epsilon(1e-12));
        CHECK(seen.honours(report));
      }
}

TEST_CASE("A maximum error is honoured, by the smallest storage that can", "[grid]") {
  const glm::i64vec3 dims(40, 24, 16);
  struct Case {
    float scale, maxError;
    const char* storage;
  };
  // Values reach 2.65 times the scale. Half floats hold steps as long as there are at most 2^11 of them,
  // floats up to 2^24.
  for (const Case& expected : {Case{1, 0.0f, "float"},
                               {1, 1e-5f, "float, steps of 1.52587891e-05"},
                               {1, 1e-3f, "half, steps of 0.001953125"},
                               {1, 0.01f, "half, steps of 0.015625"},
                               {1e6f, 100.0f, "float, steps of 128"},
                               {1e-6f, 1e-8f, "float, steps of 1.49011612e-08"},
                               {1, 1e-9f, "float"}}) {
    CAPTURE(expected.scale, expected.maxError);
    const std::vector<float> voxels = noisyVolume(dims, expected.scale);
    BuildOptions options;
    options.maxError = expected.maxError;
    MemorySource source(dims, voxels);
    const BuiltGrid built = buildGrid(source, options);
    const Plain plain = difference(*built.grid, dims, voxels);
    CHECK(built.report.storage == expected.storage);
    CHECK(plain.max == built.report.maxError);
    CHECK(plain.max <= double(expected.maxError));
    CHECK(built.grid->saveFloatAsHalf() == (built.report.storage.substr(0, 4) == "half"));
    // For a grid the same choice is made.
    MemorySource exact(dims, voxels);
    const BuiltGrid second = sparsifyGrid({buildGrid(exact).grid, "g"}, options);
    CHECK(second.report.storage == built.report.storage);
    CHECK(second.report.maxError == built.report.maxError);
  }
  // Small whole numbers are half floats already.
  MemorySource bytes({3, 1, 1}, {0, 7, 255});
  BuildOptions options;
  options.maxError = 0.0f;
  const BuiltGrid built = buildGrid(bytes, options);
  CHECK(built.report.storage == "half");
  CHECK(built.report.maxError == 0);
  options.maxError = -1.0f;
  MemorySource refused({3, 1, 1}, {0, 7, 255});
  CHECK_THROWS_WITH(buildGrid(refused, options), Contains("maximum error: expected 0 or more, found -1"));
}

TEST_CASE("Errors of conversions one after the other add up in the metadata", "[grid]") {
  const glm::i64vec3 dims(40, 24, 16);
  const std::vector<float> voxels = noisyVolume(dims, 1);
  MemorySource source(dims, voxels);
  BuildOptions first, second;
  first.step = 0.25f;
  second.half = true;
  second.tolerance = 0.3f;
  const BuiltGrid once = buildGrid(source, first);
  const BuiltGrid twice = sparsifyGrid({once.grid, "g"}, second);
  CHECK(number(*twice.grid, "error_max") == once.report.maxError + twice.report.maxError);
  const Plain plain = difference(*twice.grid, dims, voxels);
  CHECK(plain.max <= number(*twice.grid, "error_max"));
}

TEST_CASE("Verifying finds a grid that is not what the source holds", "[grid]") {
  const glm::i64vec3 dims(20, 9, 11);
  const std::vector<float> voxels = noisyVolume(dims, 1);
  MemorySource source(dims, voxels);
  BuildOptions options;
  options.clipBelow = 0.5f;
  const BuiltGrid built = buildGrid(source, options);
  const auto seen = [&](const openvdb::FloatGrid& grid) {
    MemorySource again(dims, voxels);
    return verifyGrid(again, grid, options);
  };
  CHECK(seen(*built.grid).honours(built.report));
  const auto changed = built.grid->deepCopy();
  const Coord active = changed->cbeginValueOn().getCoord();
  changed->tree().setValue(active, changed->tree().getValue(active) + 0.125f);
  CHECK(seen(*changed).error.max == Approx(0.125));
  CHECK_FALSE(seen(*changed).honours(built.report));
  const auto more = built.grid->deepCopy();
  more->tree().setValue(Coord(20, 0, 0), 1);
  CHECK(seen(*more).beyond == 1);
  const auto unclipped = built.grid->deepCopy();
  for (int x = 0; x < 20; ++x)
    if (!unclipped->tree().isValueOn(Coord(x, 0, 0))) unclipped->tree().setValue(Coord(x, 0, 0), 0.25f);
  CHECK(seen(*unclipped).wrongly > 0);
  CHECK_FALSE(seen(*unclipped).honours(built.report));
}
