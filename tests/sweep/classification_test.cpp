// Media that are interpolated between classified voxels, as a comparison: against the reference and a closed form.
// SPDX-License-Identifier: Apache-2.0
#include "support/closed_forms.h"
#include "support/random_transfer.h"
#include "sweep/picture_of_grid.h"

using namespace umbrick;

namespace {

ResolvedScene preClassified(ResolvedScene scene) {
  scene.sampling.classification = Classification::pre;
  return scene;
}

// Stripes of red and blue, one beginning in the middle of each space between two voxels of a ramp.
TransferFunction stripes() {
  std::vector<TransferFunction::Point> points{{-0.5, {glm::dvec3(0), 0}}};
  for (int i = 0; i < 26; ++i)
    for (const double at : {i - 0.4, i + 0.4}) {
      const bool solid = at > i;
      points.push_back({at, {{0.9, 0.1, 0.2}, 0.02}});
      points.push_back({at, {solid ? glm::dvec3(0.1, 0.3, 0.9) : glm::dvec3(0.9, 0.1, 0.2), solid ? 2.0 : 0.02}});
    }
  return TransferFunction(points);
}

}  // namespace

TEST_CASE("Interpolated media approach the reference on the CPU", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras()) {
    SECTION("1D") {
      checkOnCpu(grid,
                 preClassified(plainScene(
                     TransferFunction({{0.2, {kAlbedo, 0}}, {0.4, {{0.1, 0.8, 1}, 0.5}}, {0.9, {{1, 0.2, 0.1}, 2}}}),
                     camera, 0.5)),
                 2e-4, 2e-2);
    }
    SECTION("2D") {
      const Medium none{kAlbedo, 0}, some{{0.2, 0.9, 0.4}, 0.8};
      checkOnCpu(grid,
                 preClassified(plainScene(TransferFunction({0, 0.3, 1}, {0, 0.05, 0.2},
                                                           {none, none, none, none, some, none, none, some, some}),
                                          camera, 0.5)),
                 2e-4, 2e-2);
    }
    SECTION("cut") {
      ResolvedScene scene = preClassified(plainScene(ramp(0.6), camera, 0.5));
      scene.clipPlanes = {{0.3, -0.5, -0.8, 14}, {0, 1, 0, -5.3}};
      checkOnCpu(grid, scene, 1e-4, 2e-2, 2e-3);
    }
  }
}

TEST_CASE("Bricks, their culling and bands change nothing of interpolated media", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = makeDense(glm::ivec3(40, 37, 33), {-7, 3, 100});
  std::mt19937 random(9);
  Camera base;
  base.width = base.height = 40;
  ResolvedScene scene = preClassified(plainScene(randomTransferFunction(random, 8).windowed(0.1, 0.9),
                                                 orbitCamera(grid.worldBounds(), 1.1, 0.3, base), 0.5));
  const Image picture = renderedOnCpu(technique, grid, scene).colour;
  REQUIRE(largestAlpha(picture) > 0.1);
  for (const int interior : {8, 16, 64}) {
    ResolvedScene other = scene;
    other.bricks.interior = interior;
    CHECK(maxDifference(renderedOnCpu(technique, grid, other).colour, picture) < 2e-5);
    other.bricks.culling = false;
    CHECK(maxDifference(renderedOnCpu(technique, grid, other).colour, picture) < 2e-5);
  }
  ResolvedScene bands = scene;
  bands.bricks.interior = 8;
  bands.bricks.budgetMiB = 3;
  CHECK(maxDifference(renderedOnCpu(technique, grid, bands).colour, picture) < 2e-5);
}

// On a ramp of one unit a voxel the value between voxels goes through stripes that no voxel has: interpolated media do
// not know of them, and values at points miss those between two points.
TEST_CASE("What lies between the values of two voxels is lost before interpolation alone", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = fieldGrid({glm::ivec3(-1), glm::ivec3(25)}, [](const glm::dvec3& p) { return p.z; });
  ResolvedScene scene = plainScene(stripes(), orthographicCamera({12, 12, 60}, {12, 12, 0}, 10, 16), 1);
  scene.clipBox = Box{glm::dvec3(0.5), glm::dvec3(23.5)};
  const Image exact = renderReference(grid, scene).colour;
  const auto errorOf = [&](const ResolvedScene& what) {
    return rmsDifference(renderedOnCpu(technique, grid, what).colour, exact);
  };
  const double integrated = errorOf(scene);
  ResolvedScene points = scene;
  points.sampling.quadrature = Quadrature::midpoint;
  const double atPoints = errorOf(points), before = errorOf(preClassified(scene));
  INFO("integrated " << integrated << ", at points " << atPoints << ", before interpolation " << before);
  CHECK(integrated < 3e-3);
  CHECK(atPoints > 0.03);
  CHECK(before > 0.2);
  // All voxels lie in the faint stripe: with its media alone light is what 0.02 a voxel scatter over 23 voxels.
  const Image faint = renderedOnCpu(technique, grid, preClassified(scene)).colour;
  CHECK(faint.at(8, 8)[3] == Approx(-std::expm1(-0.02 * 23)).margin(1e-4));
  CHECK(faint.at(8, 8)[0] == Approx(-0.9 * std::expm1(-0.02 * 23)).margin(1e-4));
}

TEST_CASE("A renderer goes from one classification to the other and back", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  const ResolvedScene post =
      plainScene(TransferFunction({{0.2, {kAlbedo, 0}}, {0.5, {{0.1, 0.8, 1}, 3}}}), smallCameras()[1], 0.5);
  const auto bricks = cpuBricksFor(grid, post);
  RayRenderer renderer(*bricks, post);
  const Image first = renderer.render().colour;
  renderer.setScene(preClassified(post));
  const Image second = renderer.render().colour;
  CHECK(maxDifference(first, second) > 1e-2);
  CHECK(maxDifference(second, byRays(grid, preClassified(post)).colour) == 0);
  renderer.setScene(post);
  CHECK(maxDifference(renderer.render().colour, first) == 0);
  ResolvedScene lit = preClassified(post);
  lit.model = Model::cone;
  lit.method = Method::lightVolume;
  CHECK_THROWS_WITH(renderer.setScene(lit), "sampling.classification: pre is of the model emission alone, not of cone");
  CHECK_THROWS_WITH(renderReference(grid, lit),
                    Catch::Contains("sampling.classification: pre is of the model emission"));
}
