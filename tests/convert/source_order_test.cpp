// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "convert/noisy_volume.h"
#include "umbrick/convert/convert.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;

// The mask has the size of the whole input, the box counts voxels of the input, and the mean is over what both left.
TEST_CASE("A volume is masked, then cropped, then resampled", "[convert]") {
  const TemporaryFolder folder;
  NoisyVolume volume(11), mask(12);
  for (float& value : mask.voxels) value = value > 50 ? 1.0f : 0.0f;
  ConvertOptions options = noisyOptions();
  options.source.mask = mask.write(folder, "mask.raw");
  options.source.openMask = options.source.open;
  const IndexBox box{{3, 4, 5}, {16, 19, 18}};
  options.source.crop = box;
  options.source.resample = glm::dvec3(2);
  options.verify = true;
  const auto output = folder.path() / "out.vdb";
  const ConvertReport report = convert({volume.write(folder, "v.raw")}, output, options);

  const ConvertedGrid& row = report.grids.front();
  CHECK(row.resampled->dimsBefore == glm::i64vec3(14, 16, 14));
  CHECK(row.resampled->dimsAfter == glm::i64vec3(7, 8, 7));
  CHECK(row.verified->voxels == 7 * 8 * 7);
  // Only slices that the box needs are masked; each of these counts as a whole.
  std::uint64_t masked = 0;
  const ScalarGrid read = readScalarGrid(output);
  double worst = 0;
  for (int z = 0; z < 7; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 7; ++x) {
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const glm::ivec3 at =
              box.min + 2 * glm::ivec3(x, y, z) + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
          const bool stays = mask.at(at.x, at.y, at.z) != 0;
          if (stays) sum += double(volume.at(at.x, at.y, at.z));
          masked += !stays && volume.at(at.x, at.y, at.z) != 0;
        }
        worst = std::max(worst, std::abs(sum / 8 - double(read.grid->tree().getValue({x, y, z}))));
      }
  CHECK(worst < 1e-4);  // some roundings of floats below 100
  CHECK(row.masked >= masked);
  // The first new voxel covers voxels 3 and 4 along x, so that its centre is between theirs.
  const glm::dvec4 centre = read.indexToWorld() * glm::dvec4(0, 0, 0, 1);
  CHECK(glm::distance(glm::dvec3(centre), glm::dvec3(3.5, 4.5, 5.5)) < 1e-12);
}

TEST_CASE("The background of the border counts the border of the cropped volume", "[convert]") {
  const TemporaryFolder folder;
  NoisyVolume volume(13, 7);
  for (int z = 0; z < volume.kEdge; ++z)
    for (int y = 0; y < volume.kEdge; ++y)
      for (int x = 6; x < 18; ++x) volume.at(x, y, z) = 3;
  ConvertOptions options = noisyOptions();
  options.source.backgroundFromBorder = true;
  const auto input = volume.write(folder, "v.raw");
  CHECK(convert({input}, folder.path() / "all.vdb", options).grids[0].background->value == 7);
  options.source.crop = IndexBox{{6, 0, 0}, {17, 23, 23}};
  CHECK(convert({input}, folder.path() / "part.vdb", options).grids[0].background->value == 3);
}
