// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/build_grid.h"

#include <openvdb/tools/Count.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "support/memory_source.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/raw_volume.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
using Catch::Contains;
using openvdb::Coord;

namespace {

std::size_t indexOf(const glm::i64vec3& dims, int x, int y, int z) {
  return static_cast<std::size_t>((z * dims.y + y) * dims.x + x);
}

// Returns a volume with smooth blobs, plateaus and empty space, with some noise.
std::vector<float> testVolume(const glm::i64vec3& dims) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.02f, 0.02f);
  std::vector<float> voxels(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x) {
        const float wave = std::sin(0.1f * float(x)) * std::cos(0.07f * float(y)) + std::sin(0.05f * float(z));
        float value = std::max(wave, 0.0f);
        if (value > 0.9f) value = 1.5f;
        if (x % 3 != 0 && value > 0) value += noise(random);
        voxels[indexOf(dims, x, y, z)] = value;
      }
  return voxels;
}

}  // namespace

// A plain loop over all voxels of source and grid gives the numbers of the report.
TEST_CASE("Active count and maximum error are exact for any tolerance, clip, background and precision", "[grid]") {
  const glm::i64vec3 dims(37, 29, 75);
  const std::vector<float> voxels = testVolume(dims);
  for (const float tolerance : {0.0f, 0.01f, 0.05f, 0.4f})
    for (const float background : {0.0f, 1.5f})
      for (const bool toHalf : {false, true})
        for (const std::optional<float> clipBelow : {std::optional<float>(), std::optional<float>(0.2f)}) {
          CAPTURE(tolerance, background, toHalf, clipBelow.value_or(-1));
          BuildOptions options;
          options.background = background;
          options.tolerance = tolerance;
          options.half = toHalf;
          options.clipBelow = clipBelow;
          MemorySource source(dims, voxels);
          const BuiltGrid built = buildGrid(source, options);
          const auto access = built.grid->getConstAccessor();
          std::uint64_t active = 0, clipped = 0;
          double error = 0, clipChange = 0;
          for (int z = 0; z < dims.z; ++z)
            for (int y = 0; y < dims.y; ++y)
              for (int x = 0; x < dims.x; ++x) {
                const float value = voxels[indexOf(dims, x, y, z)];
                float stored = 0;
                active += access.probeValue(Coord(x, y, z), stored);
                const double difference = std::abs(double(value) - double(stored));
                if (clipBelow && value < *clipBelow) {
                  clipped += difference > 0;
                  clipChange = std::max(clipChange, difference);
                  REQUIRE(stored == background);
                } else {
                  error = std::max(error, difference);
                }
              }
          CHECK(built.report.voxels == voxels.size());
          CHECK(built.report.activeVoxels == active);
          CHECK(built.grid->activeVoxelCount() == active);
          CHECK(built.report.maxError == error);
          CHECK(built.report.clippedVoxels == clipped);
          CHECK(built.report.maxClipChange == clipChange);
          // Half floats near 1.5 are 2^-10 apart.
          CHECK(error <= std::max<double>(tolerance, toHalf ? 1.0 / 2048 : 0.0));
          CHECK(access.getValue(Coord(-1, 0, 0)) == background);
          CHECK(access.getValue(Coord(40, 30, 80)) == background);
        }
}

TEST_CASE("Without tolerance every voxel comes back", "[grid]") {
  const glm::i64vec3 dims(70, 8, 9);
  const std::vector<float> voxels = testVolume(dims);
  MemorySource source(dims, voxels);
  const BuiltGrid built = buildGrid(source);
  CHECK(built.report.maxError == 0);
  CHECK(built.grid->getGridClass() == openvdb::GRID_FOG_VOLUME);
  CHECK(built.grid->getName() == "density");
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x)
        REQUIRE(built.grid->tree().getValue(Coord(x, y, z)) == voxels[indexOf(dims, x, y, z)]);
}

TEST_CASE("Constant regions become tiles, larger ones where they fit", "[grid]") {
  const glm::i64vec3 dims(128, 128, 128);
  MemorySource source(dims, std::vector<float>(128 * 128 * 128, 2.5f));
  const BuiltGrid built = buildGrid(source);
  CHECK(built.report.leaves == 0);
  CHECK(built.report.activeTiles == 1);
  CHECK(built.report.activeVoxels == 128 * 128 * 128);
  MemorySource empty(dims, std::vector<float>(128 * 128 * 128, 0.0f));
  CHECK(buildGrid(empty).report.activeVoxels == 0);
}

TEST_CASE("Voxels that are not finite are stored as background and counted", "[grid]") {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  MemorySource source({5, 1, 1}, {1, nan, inf, -inf, 2});
  BuildOptions options;
  options.clipBelow = -100.0f;
  const BuiltGrid built = buildGrid(source, options);
  CHECK(built.report.nonFinite == 3);
  CHECK(built.report.activeVoxels == 2);
  CHECK(built.report.maxError == 0);
  CHECK(built.report.clippedVoxels == 0);
  CHECK(built.grid->tree().getValue(Coord(1, 0, 0)) == 0);
}

TEST_CASE("Transforms are kept: scale, mirror, shear, far away", "[grid]") {
  const glm::dmat4 sheared(0.5, 0.1, 0, 0, -0.2, 0.6, 0, 0, 0.05, 0, -1.5, 0, 1e7, -2e7, 3, 1);
  const glm::dmat4 scaled(0.8, 0, 0, 0, 0, -0.8, 0, 0, 0, 0, 1.5, 0, -3, 4, 5, 1);
  for (const glm::dmat4& matrix : {glm::dmat4(1), scaled, sheared}) {
    MemorySource source({2, 2, 2}, std::vector<float>(8, 1));
    source.editInfo().indexToWorld = matrix;
    const ScalarGrid grid{buildGrid(source).grid, "density"};
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)  // OpenVDB multiplies matrices on the way, which rounds the last bit
        CHECK(grid.indexToWorld()[column][row] == Approx(matrix[column][row]).epsilon(4e-16));
    CHECK(grid.activeBox() == IndexBox{{0, 0, 0}, {1, 1, 1}});
  }
  MemorySource tiny({2, 2, 2}, std::vector<float>(8, 1));
  tiny.editInfo().indexToWorld = glm::dmat4(glm::dmat3(1e-6));
  CHECK_THROWS_WITH(buildGrid(tiny), Contains("spacing: expected voxels of at least 3e-15") && Contains("1e-18"));
}

TEST_CASE("Impossible build options are refused", "[grid]") {
  const auto refused = [](const BuildOptions& options, const std::string& what) {
    MemorySource source({2, 1, 1}, {1, 70000});
    CHECK_THROWS_AS(buildGrid(source, options), InvalidArgument);
    MemorySource again({2, 1, 1}, {1, 70000});
    CHECK_THROWS_WITH(buildGrid(again, options), Contains(what));
  };
  BuildOptions options;
  options.tolerance = -1;
  refused(options, "tolerance: expected 0 or more, found -1");
  options.tolerance = std::numeric_limits<float>::quiet_NaN();
  refused(options, "tolerance");
  options = {};
  options.background = std::numeric_limits<float>::infinity();
  refused(options, "background: expected a finite number");
  options = {};
  options.half = true;
  refused(options, "expected values up to 65504 in magnitude, found 70000");
}

TEST_CASE("A grid with tiles, a background and inactive values is made sparse with an exact report", "[grid]") {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(0.25f);
  grid->tree().addTile(2, Coord(0), 0.3f, true);       // 128^3 voxels within the tolerance of the background
  grid->tree().addTile(1, Coord(200, 0, 0), 4, true);  // 8^3 voxels
  for (int i = 0; i < 512; ++i)
    grid->tree().setValue(Coord(304 + (i >> 6), i >> 3 & 7, i & 7), 2.0f + 0.0001f * float(i));
  grid->tree().setValue(Coord(-5, -6, -7), 0.1f);
  grid->tree().setValueOff(Coord(-6, -6, -7), 9.0f);
  BuildOptions options;
  options.tolerance = 0.06f;
  options.clipBelow = 0.2f;
  const BuiltGrid built = sparsifyGrid({grid, "g"}, options);
  CHECK(built.report.voxels == 128 * 128 * 128 + 512 + 512 + 1);
  CHECK(built.report.activeVoxels == 1024);
  CHECK(built.report.activeTiles == 2);
  CHECK(built.report.clippedVoxels == 1);
  CHECK(built.grid->metaValue<std::int64_t>("clipped_voxels") == 1);
  CHECK(sparsifyGrid({built.grid, "again"}, options).grid->metaValue<std::int64_t>("clipped_voxels") == 1);
  CHECK(built.report.maxClipChange == std::abs(double(0.1f) - 0.25));
  CHECK(built.report.maxError == double(0.3f) - 0.25);
  CHECK(built.grid->tree().getValue(Coord(5, 5, 5)) == 0.25f);
  CHECK(built.grid->tree().getValue(Coord(-6, -6, -7)) == 9.0f);
  CHECK_FALSE(built.grid->tree().isValueOn(Coord(-6, -6, -7)));
  CHECK(grid->activeVoxelCount() == built.report.voxels);  // the source is as it was
}

TEST_CASE("A level set keeps its values, and rounds to half on request", "[grid]") {
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10, openvdb::Vec3f(1, 2, 3), 0.7f);
  BuildOptions options;
  options.tolerance = 5;
  options.clipBelow = 0.0f;
  options.background = 7.0f;
  const BuiltGrid same = sparsifyGrid({sphere, "s"}, options);
  CHECK(same.report.maxError == 0);
  CHECK(same.grid->getGridClass() == openvdb::GRID_LEVEL_SET);
  options = {};
  options.half = true;
  const BuiltGrid rounded = sparsifyGrid({sphere, "s"}, options);
  double error = std::abs(double(sphere->background()) - double(rounded.grid->background()));
  for (int x = -20; x < 24; ++x)
    for (int y = -20; y < 24; ++y)
      for (int z = -20; z < 24; ++z) {
        const float before = sphere->tree().getValue(Coord(x, y, z));
        REQUIRE(same.grid->tree().getValue(Coord(x, y, z)) == before);
        REQUIRE(same.grid->tree().isValueOn(Coord(x, y, z)) == sphere->tree().isValueOn(Coord(x, y, z)));
        error = std::max(error, std::abs(double(before) - double(rounded.grid->tree().getValue(Coord(x, y, z)))));
      }
  CHECK(rounded.report.maxError == error);
  CHECK(error > 0);
  // The report speaks of the values as they are written, in half floats.
  const TemporaryFolder folder;
  writeGrids(folder.path() / "s.vdb", {rounded.grid});
  const ScalarGrid back = readScalarGrid(folder.path() / "s.vdb");
  CHECK(back.grid->background() == rounded.grid->background());
  for (auto value = rounded.grid->cbeginValueAll(); value; ++value)
    if (value.isVoxelValue()) REQUIRE(back.grid->tree().getValue(value.getCoord()) == *value);
}

TEST_CASE("The bundled head scan has the known share of voxels above 500", "[grid]") {
  RawOptions raw{{256, 256, 94}, VoxelType::u16};
  raw.bitsStored = 15;
  raw.spacing = {0.8, 0.8, 1.5};
  const auto source = openRaw(UMBRICK_ASSETS "/headsq_256x256x94_uint16le.raw.gz", raw);
  BuildOptions options;
  options.clipBelow = 501.0f;
  const BuiltGrid built = buildGrid(*source, options);
  CHECK(std::round(1e4 * double(built.report.activeVoxels) / double(built.report.voxels)) == 3733);  // 37.33 %
  CHECK(built.report.maxError == 0);
  const auto extremes = openvdb::tools::minMax(built.grid->tree());
  CHECK(extremes.min() == 501);
  CHECK(extremes.max() == 4095);
}
