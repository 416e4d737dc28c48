// Projections of values by rays on OpenGL: against voxel columns, rays on the CPU, the reference, and what must not
// change them.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/gl_fixture.h"
#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;

namespace {

constexpr Mode kValueModes[]{Mode::mip, Mode::minip, Mode::average};

ResolvedScene projectionScene(Mode mode, const Camera& camera) {
  ResolvedScene scene = plainScene(TransferFunction({{0, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), 1}}}), camera, 1);
  scene.mode = mode;
  return scene;
}

Picture castProjection(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                       const AtlasLimits& limits = {}) {
  const auto volume = valueBricks(grid, scene);
  return RayCaster(context, *volume, scene, {}, limits).render();
}

ScalarGrid blobs() { return makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs); }

double meanOf(const Image& image) {
  double sum = 0;
  for (const float value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

// Single precision knows places within the volumes of these tests to 1e-5 of a voxel, over which values change by up to
// 1; of rays that run along an edge of the volume it may lose a slice.
constexpr double kSamePlaces = 5e-5;

}  // namespace

// As numpy's max, min and mean over an axis. Steps of a value choose the format of texels.
TEST_CASE("A face-on parallel projection on OpenGL is that of voxel columns, to the last bit",
          "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::ivec3 dims(37, 29, 50);
  for (const double steps : {250.0, 60000.0, 0.0}) {
    TestRandom random(3);
    const ScalarGrid grid = makeFilled(
        dims, glm::ivec3(0),
        [&](const glm::ivec3&) {
          const double value = random.uniform();
          return steps > 0 ? std::floor(steps * value) - 100 : value - 0.3;
        },
        steps > 0 ? -200 : -1);
    const auto accessor = grid.grid->getConstAccessor();
    for (int axis = 0; axis < 3; ++axis)
      for (const Mode mode : kValueModes) {
        INFO("steps " << steps << ", axis " << axis << ", mode " << modeName(mode));
        const Picture picture = castProjection(*context, grid, projectionScene(mode, faceOnCamera(dims, axis)));
        const Image& values = layerOf(picture, "value");
        double worst = 0;
        for (int y = 0; y < values.height; ++y)
          for (int x = 0; x < values.width; ++x) {
            float most = -1e9f, least = 1e9f;
            double sum = 0;
            for (int n = 0; n < dims[axis]; ++n) {
              openvdb::Coord at;
              at[axis] = n;
              at[(axis + 1) % 3] = x;
              at[(axis + 2) % 3] = y;
              const float value = accessor.getValue(at);
              most = std::max(most, value);
              least = std::min(least, value);
              sum += value * (n == 0 || n + 1 == dims[axis] ? 0.5 : 1);
            }
            const double expected = mode == Mode::mip ? most : mode == Mode::minip ? least : sum / (dims[axis] - 1);
            worst = std::max(worst, std::abs(*values.at(x, y) - expected));
          }
        // Means are of up to 50 floats.
        CHECK(worst <= (mode == Mode::average ? 1e-6 * std::max(steps, 1.0) : 0));
      }
  }
}

TEST_CASE("Projections on OpenGL are those on the CPU and approach the reference", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(blobs(), crookedTransform());
  Camera base;
  base.width = base.height = 24;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const double azimuth : {0.3, 1.7, 3.9}) {
      base.projection = projection;
      const Camera camera = orbitCamera(grid.worldBounds(), azimuth, 0.4, base);
      for (const Mode mode : kValueModes) {
        ResolvedScene scene = projectionScene(mode, camera);
        INFO("azimuth " << azimuth << ", perspective " << (projection == Projection::perspective) << ", mode "
                        << modeName(mode));
        // Thick slabs, which leave minima something to find between the blobs and nothing.
        if (mode == Mode::minip) {
          const glm::dvec3 forward = cameraFrame(camera).forward, middle = grid.worldBounds().centre();
          scene.clipPlanes = {{forward, 1 - glm::dot(forward, middle)}, {-forward, 1 + glm::dot(forward, middle)}};
        }
        const Picture ours = castProjection(*context, grid, scene), theirs = valuePicture(grid, scene);
        // A packet of the CPU's rays has one main axis, so that a ray near a diagonal may have other slices there.
        CHECK(rmsDifference(layerOf(ours, "value"), layerOf(theirs, "value")) < 1e-3);
        scene.sampling.spacing = 0.125 * shortestVoxelEdge(grid.indexToWorld());
        const Image exact = layerOf(renderReference(grid, scene), "value");
        CHECK(meanOf(exact) > 0.005);
        CHECK(rmsDifference(layerOf(castProjection(*context, grid, scene), "value"), exact) <
              (mode == Mode::average ? 2e-4 : 1e-3));
      }
    }
}

// Parallel rays of one picture have one main axis in all techniques.
TEST_CASE("Parallel projections on OpenGL have the samples of those on the CPU", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobs();
  for (const int perVoxel : {1, 3})
    for (const Mode mode : kValueModes) {
      ResolvedScene scene = projectionScene(mode, orthographicCamera({30, 22, 40}, kSmallCentre, 30, 32));
      scene.sampling.spacing = 1.0 / perVoxel;
      INFO("samples " << perVoxel << ", mode " << modeName(mode));
      const Picture ours = castProjection(*context, grid, scene), theirs = valuePicture(grid, scene);
      CHECK(maxDifference(layerOf(ours, "value"), layerOf(theirs, "value")) < kSamePlaces);
      CHECK(maxDifference(ours.colour, theirs.colour) < 1e-3);  // the slope of sRGB near black
    }
}

TEST_CASE("Bricks that are skipped, cut and drawn in runs change no projection on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Mode mode : kValueModes)
    for (const bool perspective : {false, true}) {
      INFO("mode " << modeName(mode) << ", perspective " << perspective);
      // Between balls every ray has a minimum of nothing.
      const ScalarGrid grid = mode == Mode::minip ? makeDense({70, 50, 90}, glm::ivec3(-5, 7, 2))
                                                  : makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
      const glm::dvec3 centre = grid.worldBounds().centre();
      ResolvedScene scene =
          projectionScene(mode, perspective ? perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 40)
                                            : orthographicCamera(centre + glm::dvec3(-70, 90, 120), centre, 120, 40));
      const Picture first = castProjection(*context, grid, scene);
      const Image& skipped = layerOf(first, "value");
      CHECK(meanOf(skipped) > 0.001);
      AtlasLimits small;
      small.budgetBytes = first.stats.textureBytes / 5;
      const Picture inRuns = castProjection(*context, grid, scene, small);
      CHECK(inRuns.stats.textureBytes < first.stats.textureBytes / 2);
      CHECK(maxDifference(layerOf(inRuns, "value"), skipped) <= (mode == Mode::average ? 1e-5 : 0));
      scene.bricks.culling = false;
      const Image all = layerOf(castProjection(*context, grid, scene), "value");
      CHECK(maxDifference(skipped, all) <= (mode == Mode::average ? 1e-6 : 0));
      scene.bricks.bricked = false;
      const Image whole = layerOf(castProjection(*context, grid, scene), "value");
      CHECK(maxDifference(all, whole) < 10 * kSamePlaces);
    }
}

TEST_CASE("An eye within the volume projects what is before it on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobs();
  for (const double fov : {0.5, 2.4})
    for (const Mode mode : {Mode::mip, Mode::average}) {
      ResolvedScene scene =
          projectionScene(mode, perspectiveCamera({12.3, 9.1, 17.2}, kSmallCentre + glm::dvec3(0.3, 0.5, -1), fov, 24));
      scene.sampling.spacing = 0.125;
      INFO("fov " << fov << ", mode " << modeName(mode));
      const Image exact = layerOf(renderReference(grid, scene), "value");
      CHECK(meanOf(exact) > 0.02);
      CHECK(rmsDifference(layerOf(castProjection(*context, grid, scene), "value"), exact) < 2e-3);
    }
}

TEST_CASE("A slab that is thinner than a voxel is projected on OpenGL as what it holds", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(16), glm::ivec3(0), [](const glm::ivec3& i) { return 0.05 * i.z; });
  ResolvedScene scene = projectionScene(Mode::mip, orthographicCamera({7.5, 7.5, 60}, {7.5, 7.5, 7.5}, 12, 8));
  scene.camera.up = {0, 1, 0};
  scene.clipBox = Box{{-50, -50, 6.3}, {50, 50, 6.6}};
  for (const Mode mode : kValueModes) {
    scene.mode = mode;
    const double expected = 0.05 * (mode == Mode::mip ? 6.6 : mode == Mode::minip ? 6.3 : 6.45);
    const Picture picture = castProjection(*context, grid, scene);
    for (const float value : layerOf(picture, "value").pixels) CHECK(value == Approx(expected).epsilon(1e-5));
  }
}

TEST_CASE("An X-ray on OpenGL is what emission leaves of the light behind it", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobs();
  ResolvedScene scene = projectionScene(Mode::xray, orthographicCamera({30, 22, 40}, kSmallCentre, 30, 32));
  scene.sampling.spacing = 0.25;
  const Picture picture = castProjection(*context, grid, scene);
  const Image& through = layerOf(picture, "value");
  const Image exact = layerOf(renderReference(grid, scene), "value");
  CHECK(meanOf(exact) < 0.9);
  // The value counts as linear between samples, and has kinks at voxels.
  CHECK(rmsDifference(through, exact) < 5e-4);
  CHECK(rmsDifference(through, layerOf(valuePicture(grid, scene, 4), "value")) < 5e-4);
  scene.mode = Mode::integrate;
  scene.sampling.saturation = 0;
  const Image colour = castProjection(*context, grid, scene).colour;
  for (std::size_t i = 0; i < through.pixels.size(); ++i) CHECK(through.pixels[i] == 1 - colour.pixels[4 * i + 3]);
}

TEST_CASE("A renderer on OpenGL goes from mode to mode", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobs();
  const ResolvedScene first = projectionScene(Mode::integrate, orthographicCamera({30, 22, 40}, kSmallCentre, 30, 24));
  const auto bricks = cutGrid(grid, BrickOptions{.interior = 16, .apron = 2}, true);
  RayCaster renderer(*context, *bricks, first);
  for (const Mode mode : {Mode::mip, Mode::integrate, Mode::minip, Mode::xray, Mode::isosurface, Mode::average,
                          Mode::isosurface, Mode::integrate}) {
    ResolvedScene scene = first;
    scene.mode = mode;
    if (mode == Mode::isosurface) scene.surfaces = {surfaceAt(0.4)};
    renderer.setScene(scene);
    INFO("mode " << modeName(mode));
    CHECK(maxDifference(renderer.render().colour, RayCaster(*context, *bricks, scene).render().colour) == 0);
  }
}
