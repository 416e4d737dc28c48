// Volumes that do not fit the memory budget: bands of rows, and that their pictures are those of all bricks at once.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_bands.h"

#include "sweep/picture_of_grid.h"

using namespace umbrick;

namespace {

// Floats in bricks of 8: 13 x 13 x 13 of them take 8.4 MiB.
ScalarGrid largeGrid() { return makeDense(glm::ivec3(100), {-7, 3, 100}); }

ResolvedScene largeScene(const Camera& camera) {
  ResolvedScene scene = plainScene(
      TransferFunction({{0.2, {kAlbedo, 0}}, {0.5, {{0.2, 0.4, 1}, 0.05}}, {0.9, {kAlbedo, 0.3}}}), camera, 1);
  scene.bricks.interior = 8;
  return scene;
}

}  // namespace

TEST_CASE("Bands cover all rows once, and their bricks fit", "[sweep]") {
  TestRandom random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const int rows = 1 + random.below(200), multiple = trial % 2 ? 4 : 1;
    std::vector<RowSpan> bricks(60);
    for (RowSpan& brick : bricks) {
      brick.first = random.below(rows + 20) - 10;
      brick.last = brick.first + random.below(30) - 2;
    }
    std::uint64_t most = 0;
    for (int row = 0; row < rows; row += multiple) {
      std::uint64_t seen = 0;
      for (const RowSpan& brick : bricks) seen += brick.meets(row, std::min(row + multiple, rows));
      most = std::max(most, seen);
    }
    most = most * 10 + 5;
    const std::vector<RowBand> bands = cutBands(bricks, rows, multiple, 10, most);
    int next = 0;
    for (const RowBand& band : bands) {
      CHECK(band.begin == next);
      CHECK(band.end > band.begin);
      next = band.end;
      std::uint64_t seen = 0;
      for (const RowSpan& brick : bricks) seen += brick.meets(band.begin, band.end);
      CHECK(10 * seen <= most);
    }
    CHECK(next == rows);
  }
  const std::vector<RowSpan> two{{0, 9}, {5, 7}};
  CHECK(cutBands(two, 20, 1, 10, 20).size() == 1);
  CHECK_THROWS_WITH(cutBands(two, 20, 1, 10, 19), Catch::Contains("bricks.budgetMiB: the 2 bricks that row 5 of"));
}

TEST_CASE("A picture in bands is that of all bricks at once", "[sweep][cpu][slow]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  // A row of pixels sees up to 5 MiB from within.
  constexpr std::uint64_t kBudget = 6 << 20;
  const ScalarGrid grid = largeGrid();
  Camera base;
  base.width = base.height = 48;
  std::vector<Camera> cameras;
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    base.projection = projection;
    for (const double azimuth : {0.2, 2.1, 4.4}) cameras.push_back(orbitCamera(grid.worldBounds(), azimuth, 0.5, base));
  }
  // From within, in a view of several main axes.
  cameras.push_back(perspectiveCamera({40, 52, 150}, {90, 60, 160}, 1.8, 48));
  for (const Camera& camera : cameras)
    for (const bool lit : {false, true}) {
      ResolvedScene scene = largeScene(camera);
      if (lit) {
        scene.model = Model::cone;
        scene.method = Method::lightVolume;
        scene.occlusion.ordinates.directions = 4;
      }
      INFO("eye " << camera.eye.x << " " << camera.eye.y << " " << camera.eye.z << ", light " << lit);
      const Picture whole = renderedOnCpu(technique, grid, scene, kLayers);
      REQUIRE(largestAlpha(whole.colour) > 0.1);
      const std::uint64_t light = lit ? 3 : 2;  // halves of the voxels' bytes
      REQUIRE(whole.stats.textureBytes > light * kBudget / 2);
      scene.bricks.budgetMiB = kBudget >> 20;
      const Picture bands = renderedOnCpu(technique, grid, scene, kLayers);
      CHECK(maxDifference(bands.colour, whole.colour) < 2e-5);
      CHECK(bands.stats.visibleBricks == whole.stats.visibleBricks);
      // With the ranges of groups and what is beyond the voxels for reading several at once.
      CHECK(bands.stats.textureBytes < 1.1 * static_cast<double>(light * kBudget) / 2);
    }
}

TEST_CASE("A picture whose least band does not fit is refused in one line", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = largeGrid();
  Camera base;
  base.width = base.height = 1;
  ResolvedScene scene = largeScene(orbitCamera(grid.worldBounds(), 0.2, 0.5, base));
  scene.bricks.culling = false;
  scene.bricks.budgetMiB = 1;
  scene.bricks.interior = 48;
  if (technique == Technique::rays)
    CHECK_THROWS_WITH(renderedOnCpu(technique, grid, scene), Catch::Contains("bricks.budgetMiB: the "));
  scene.bricks.budgetMiB = 0;
  CHECK_THROWS_WITH(renderedOnCpu(technique, grid, scene),
                    Catch::Contains("bricks.budgetMiB: the voxels of one brick"));
}
