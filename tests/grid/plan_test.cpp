// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/plan.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <vector>

#include "support/memory_source.h"
#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/ingest/raw_volume.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

struct Ball {
  glm::dvec3 centre;
  double radius;
};

// Balls that are soft at the edge and 1 inside, with some waves so that packing has work.
std::vector<float> balls(const glm::i64vec3& dims, const std::vector<Ball>& all) {
  std::vector<float> out(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (const Ball& ball : all) {
    const glm::i64vec3 low = glm::max(glm::i64vec3(ball.centre - ball.radius), glm::i64vec3(0));
    const glm::i64vec3 high =
        glm::min(glm::i64vec3(ball.centre + ball.radius) + std::int64_t(1), dims - std::int64_t(1));
    for (std::int64_t z = low.z; z <= high.z; ++z)
      for (std::int64_t y = low.y; y <= high.y; ++y)
        for (std::int64_t x = low.x; x <= high.x; ++x) {
          const double inside = (ball.radius - glm::distance(ball.centre, glm::dvec3(x, y, z))) / 3;
          if (inside > 0)
            out[std::size_t((z * dims.y + y) * dims.x + x)] =
                static_cast<float>(std::min(inside, 1.0) * (inside > 5 ? 1 : 1 + 0.1 * std::sin(0.3 * double(x + y))));
        }
  }
  return out;
}

std::vector<Ball> scattered(const glm::i64vec3& dims, int count, unsigned seed) {
  TestRandom random(seed);
  std::vector<Ball> out;
  for (int i = 0; i < count; ++i) out.push_back({random.point(glm::dvec3(0), glm::dvec3(dims)), random.uniform(3, 12)});
  return out;
}

// @param uncounted  share of what was made that a plan does not count
void checkEstimate(const char* what, const Estimate& planned, double made, double uncounted) {
  INFO(what << ": " << planned.value << " +- " << planned.uncertainty << ", made " << made);
  CHECK(std::abs(planned.value - made) <= planned.uncertainty + uncounted * made);
}

template <class Open>
GridPlan compare(const Open& open, const BuildOptions& options, const PlanOptions& plan) {
  const TemporaryFolder folder;
  const GridPlan planned = planGrid(*open(), options, plan);
  const BuiltGrid built = buildGrid(*open(), options);
  writeGrids(folder.path() / "v.vdb", {built.grid}, {}, plan.codec);
  checkEstimate("active voxels", planned.activeVoxels, double(built.report.activeVoxels), 0);
  checkEstimate("leaves", planned.leaves, double(built.report.leaves), 0);
  // The plan does not count the root, and the tiles and text of the file.
  checkEstimate("memory", planned.gridBytes, double(built.grid->memUsage()), 0.005);
  checkEstimate("file", planned.fileBytes, double(std::filesystem::file_size(folder.path() / "v.vdb")), 0.01);
  CHECK(planned.storage == built.report.storage);
  return planned;
}

PlanOptions sampled(VdbCodec codec = VdbCodec::blosc) {
  PlanOptions plan;
  plan.wholeVoxels = 0;
  plan.codec = codec;
  return plan;
}

}  // namespace

// The seeds are fixed, so that a limit of 95 % confidence holds always or never.
TEST_CASE("Plans from a tenth of the voxels are off by no more than they say: balls, scattered and alone", "[grid]") {
  const glm::i64vec3 dims(96, 80, 480);
  BuildOptions tolerant, within;
  tolerant.tolerance = 0.2f;
  within.maxError = 0.02f;
  for (const unsigned seed : {1u, 2u, 3u, 4u})
    for (const int count : {8, 40, 200}) {
      CAPTURE(seed, count);
      const std::vector<float> voxels = balls(dims, scattered(dims, count, seed));
      const auto open = [&] { return std::make_unique<MemorySource>(dims, voxels); };
      const BuildOptions options = seed == 1 ? tolerant : seed == 2 ? within : BuildOptions();
      const GridPlan plan = compare(open, options, sampled(seed == 3 ? VdbCodec::zip : VdbCodec::blosc));
      CHECK(plan.layersRead == 6);
      CHECK(plan.voxelsRead == plan.voxels / 10);
    }
  const std::vector<float> one = balls(dims, {{{48, 40, 200}, 39}});
  compare([&] { return std::make_unique<MemorySource>(dims, one); }, {}, sampled());
}

TEST_CASE("Plans of the head are off by no more than they say, and exact when all of it is read", "[grid]") {
  BuildOptions skin;
  skin.clipBelow = 501.0f;
  const auto open = [] {
    return openRaw(UMBRICK_ASSETS "/headsq_256x256x94_uint16le.raw.gz",
                   {{256, 256, 94}, VoxelType::u16, std::endian::little, 0, 15});
  };
  CHECK(compare(open, skin, sampled()).layersRead == 5);
  const GridPlan whole = compare(open, skin, {});
  CHECK(whole.voxelsRead == whole.voxels);
  CHECK(whole.activeVoxels.value == 2299643);  // the number that convert reports
  CHECK(whole.activeVoxels.uncertainty == 0);
  CHECK(whole.leaves.uncertainty == 0);
  CHECK(whole.gridBytes.uncertainty == 0);
  // There are two voxel slabs, each of 32 slices of u16.
  CHECK(whole.peakBytes.value == Approx(whole.gridBytes.value + 2 * 256 * 256 * 32 * 2));
}

TEST_CASE("A plan that met nothing says how much may lie between what it read", "[grid]") {
  const glm::i64vec3 dims(40, 24, 800);
  std::vector<float> voxels(40 * 24 * 800);
  const auto plan = [&] { return planGrid(*std::make_unique<MemorySource>(dims, voxels), {}, sampled()); };
  CHECK(plan().activeVoxels.value == 0);
  // Ten layers of a hundred were read, so nine may hide between two of them.
  CHECK(plan().activeVoxels.uncertainty == Approx(9 * 40 * 24 * 8));
  CHECK(plan().leaves.uncertainty == Approx(9 * 5 * 3));
  std::fill(voxels.begin(), voxels.end(), 1.5f);
  CHECK(plan().activeVoxels.value == Approx(40 * 24 * 800));
  CHECK(plan().leaves.value == 0);  // all are tiles
  CHECK(plan().leaves.uncertainty == 0);
}

TEST_CASE("Plans refuse what a conversion would refuse", "[grid]") {
  const auto plan = [](const BuildOptions& options, double share) {
    MemorySource source({4, 1, 1}, {1, 2, 1e6f, 4});
    PlanOptions asked;
    asked.share = share;
    planGrid(source, options, asked);
  };
  BuildOptions asHalf, tolerance;
  asHalf.half = true;
  tolerance.tolerance = -1;
  CHECK_THROWS_WITH(plan(asHalf, 0.1), Contains("expected values up to 65504 in magnitude, found 1000000"));
  CHECK_THROWS_WITH(plan(tolerance, 0.1), Contains("tolerance: expected 0 or more, found -1"));
  CHECK_THROWS_WITH(plan({}, 0), Contains("plan: expected a share in (0, 1], found 0"));
}
