// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "convert/noisy_volume.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/convert/plan_volumes.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/grid_listing.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// The largest |volume - file| over the voxels of the volume.
double largestError(NoisyVolume& volume, const std::filesystem::path& file, const std::string& grid) {
  const ScalarGrid read = readScalarGrid(file, grid);
  const auto values = read.grid->getConstAccessor();
  double largest = 0;
  for (int z = 0; z < volume.kEdge; ++z)
    for (int y = 0; y < volume.kEdge; ++y)
      for (int x = 0; x < volume.kEdge; ++x)
        largest = std::max(largest, std::abs(double(volume.at(x, y, z)) - double(values.getValue({x, y, z}))));
  return largest;
}

}  // namespace

TEST_CASE("A converted volume that is read back differs from its source by the stated error", "[convert]") {
  const TemporaryFolder folder;
  NoisyVolume volume(5, 7);
  const auto input = volume.write(folder, "v.raw");
  const auto check = [&](const char* output, const ConvertOptions& options) {
    CAPTURE(output);
    const auto path = folder.path() / output;
    const ConvertReport report = convert({input}, path, options);
    REQUIRE(report.grids.size() == 1);
    const ConvertedGrid& grid = report.grids.front();
    const double error = largestError(volume, path, "density");
    CHECK(error <= grid.build.maxError);
    CHECK(grid.verified->error.max == Approx(error).margin(1e-12));
    CHECK(grid.build.voxels == volume.voxels.size());
    CHECK(grid.volumeType == VoxelType::f32);
    CHECK(report.output == path);
    CHECK(report.bytesIn == std::int64_t(std::filesystem::file_size(input)));
    CHECK(report.bytesOut == std::int64_t(std::filesystem::file_size(path)));
    return grid;
  };
  ConvertOptions options = noisyOptions();
  options.verify = true;
  options.source.backgroundFromBorder = true;
  const ConvertedGrid exact = check("exact.vdb", options);
  CHECK(exact.build.maxError == 0);
  CHECK(exact.background->value == 7);
  CHECK(exact.build.activeVoxels == 16 * 16 * 16);  // the block: noise is never just 7

  options.build.maxError = 0.5f;
  CHECK(check("rough.vdb", options).build.maxError <= 0.5);
  options.output.nano = NanoOptions{NanoValues::adaptive};  // shares the error with what is left out
  CHECK(check("adaptive.nvdb", options).build.maxError <= 0.5);
  options.build.maxError.reset();
  options.output.nano = NanoOptions{NanoValues::bits8};
  CHECK(check("eight.nvdb", options).build.quantising.max > 0);
}

TEST_CASE("Several volumes become grids of one file, each with its own name, unit and error", "[convert]") {
  const TemporaryFolder folder;
  NoisyVolume heat(1), smoke(2);
  const std::vector inputs{heat.write(folder, "heat.raw.gz"), smoke.write(folder, "smoke.raw")};
  ConvertOptions options = noisyOptions();
  options.build.tolerance = 0.25f;
  options.units = {"K", "kg/m3"};
  const auto output = folder.path() / "both.vdb";
  const ConvertReport report = convert(inputs, output, options);
  REQUIRE(report.grids.size() == 2);
  CHECK(report.grids[0].label == "heat");
  CHECK(report.grids[1].label == "smoke");
  CHECK(report.grids[1].input == inputs[1]);
  CHECK(largestError(heat, output, "heat") <= report.grids[0].build.maxError);
  CHECK(largestError(smoke, output, "smoke") <= report.grids[1].build.maxError);
  CHECK(readScalarGrid(output, "smoke").grid->metaValue<std::string>("value_unit") == "kg/m3");
  CHECK_FALSE(report.grids[0].masked);
  CHECK_FALSE(report.grids[0].verified);
}

// Small volumes are read as a whole, so that nothing is estimated.
TEST_CASE("A plan of a small volume is what its conversion makes", "[convert]") {
  const TemporaryFolder folder;
  const auto input = NoisyVolume(3, 2).write(folder, "v.raw");
  ConvertOptions options = noisyOptions();
  options.source.backgroundFromBorder = true;
  options.source.crop = IndexBox{{0, 0, 0}, {23, 23, 11}};
  const std::vector<VolumePlan> plans = planVolumes({input}, options);
  const ConvertReport report = convert({input}, folder.path() / "v.vdb", options);
  REQUIRE(plans.size() == 1);
  CHECK(plans[0].background->value == report.grids[0].background->value);
  CHECK(plans[0].grid.activeVoxels.value == double(report.grids[0].build.activeVoxels));
  CHECK(plans[0].grid.leaves.value == double(report.grids[0].build.leaves));
  CHECK(plans[0].grid.activeVoxels.uncertainty == 0);
}

TEST_CASE("Progress of each stage begins at 0 and does not fall", "[convert]") {
  const TemporaryFolder folder;
  const auto input = NoisyVolume(4).write(folder, "v.raw");
  ConvertOptions options = noisyOptions();
  options.verify = true;
  std::vector<ConvertProgress> seen;
  options.progress = [&](const ConvertProgress& now) { seen.push_back(now); };
  convert({input}, folder.path() / "v.vdb", options);
  REQUIRE(seen.size() >= 2);
  CHECK(seen.front().stage == ConvertStage::converting);
  CHECK(seen.back().stage == ConvertStage::verifying);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool begins = i == 0 || seen[i].stage != seen[i - 1].stage;
    CHECK(seen[i].share >= (begins ? 0 : seen[i - 1].share));
    if (begins) CHECK(seen[i].share == 0);
    CHECK(seen[i].share <= 1);
    CHECK(seen[i].input == input);
    CHECK(seen[i].bytes == 4.0 * 24 * 24 * 24);
  }
}
