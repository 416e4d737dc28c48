// Projections of values by rays on the CPU: against voxel columns, the reference, and what must not change them.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "core/baseline_instructions.h"
#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/core/srgb.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/optics/projection_colour.h"

using namespace umbrick;

namespace {

constexpr Mode kValueModes[]{Mode::mip, Mode::minip, Mode::average};

ResolvedScene projectionScene(Mode mode, const Camera& camera) {
  ResolvedScene scene = plainScene(TransferFunction({{0, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), 1}}}), camera, 0.5);
  scene.mode = mode;
  return scene;
}

ScalarGrid blobs() { return makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs); }

double meanOf(const Image& image) {
  double sum = 0;
  for (const float value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

}  // namespace

// As numpy's max, min and mean over an axis. Steps of a value choose whether voxels are held as bytes, as 16 bits or as
// floats.
TEST_CASE("A face-on parallel projection is that of voxel columns, to the last bit", "[sweep][cpu][modes]") {
  const glm::ivec3 dims(37, 29, 50);
  for (const double steps : {250.0, 60000.0, 0.0})
    for (const bool baseline : {false, true}) {
      TestRandom random(3);
      const ScalarGrid grid = makeFilled(
          dims, glm::ivec3(0),
          [&](const glm::ivec3&) {
            const double value = random.uniform();
            return steps > 0 ? std::floor(steps * value) - 100 : value - 0.3;
          },
          steps > 0 ? -200 : -1);
      const auto accessor = grid.grid->getConstAccessor();
      useBaselineInstructions(baseline);
      for (int axis = 0; axis < 3; ++axis)
        for (const Mode mode : kValueModes) {
          INFO("steps " << steps << ", axis " << axis << ", mode " << modeName(mode) << ", baseline " << baseline);
          const Picture picture = valuePicture(grid, projectionScene(mode, faceOnCamera(dims, axis)), 1);
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
                // The mean over the way from the first voxel to the last one, which are its ends.
                sum += value * (n == 0 || n + 1 == dims[axis] ? 0.5 : 1);
              }
              const double expected = mode == Mode::mip ? most : mode == Mode::minip ? least : sum / (dims[axis] - 1);
              worst = std::max(worst, std::abs(*values.at(x, y) - expected));
            }
          // Means are of up to 50 floats.
          CHECK(worst <= (mode == Mode::average ? 1e-6 * std::max(steps, 1.0) : 0));
        }
      useBaselineInstructions(false);
    }
}

TEST_CASE("Projections approach the reference from all sides", "[sweep][cpu][modes]") {
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
        const Image exact = layerOf(renderReference(grid, scene), "value");
        const Image coarse = layerOf(valuePicture(grid, scene, 1), "value");
        const Image fine = layerOf(valuePicture(grid, scene, 8), "value");
        // A sample is off by the square of the distance where the field is smooth, and by its first power at the tips
        // of trilinear fields, which extremes look for. The values are up to 1.
        CHECK(meanOf(exact) > 0.005);
        CHECK(rmsDifference(coarse, exact) < 1e-2);
        CHECK(rmsDifference(fine, exact) < (mode == Mode::average ? 2e-4 : 1e-3));
        if (mode == Mode::average) continue;
        // No sample is beyond the extreme itself.
        double beyond = 0;
        for (std::size_t i = 0; i < fine.pixels.size(); ++i)
          beyond = std::max<double>(beyond, (fine.pixels[i] - exact.pixels[i]) * (mode == Mode::mip ? 1 : -1));
        CHECK(beyond < 1e-5);
      }
    }
}

TEST_CASE("Bricks that are skipped and cut change no projection", "[sweep][cpu][modes]") {
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
      const Image skipped = layerOf(valuePicture(grid, scene), "value");
      scene.bricks.culling = false;
      const Image all = layerOf(valuePicture(grid, scene), "value");
      scene.bricks.bricked = false;
      const Image whole = layerOf(valuePicture(grid, scene), "value");
      CHECK(meanOf(all) > 0.001);
      // Means are sums of floats in another order.
      CHECK(maxDifference(skipped, all) <= (mode == Mode::average ? 1e-6 : 0));
      // Places within bricks are floats from another origin.
      CHECK(maxDifference(all, whole) < 1e-4);
    }
}

TEST_CASE("An eye within the volume, and views of more than 90 degrees, project what is before it",
          "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobs();
  for (const double fov : {0.5, 2.4})
    for (const Mode mode : {Mode::mip, Mode::average}) {
      const ResolvedScene scene =
          projectionScene(mode, perspectiveCamera({12.3, 9.1, 17.2}, kSmallCentre + glm::dvec3(0.3, 0.5, -1), fov, 24));
      INFO("fov " << fov << ", mode " << modeName(mode));
      const Image exact = layerOf(renderReference(grid, scene), "value");
      CHECK(meanOf(exact) > 0.02);
      CHECK(rmsDifference(layerOf(valuePicture(grid, scene, 8), "value"), exact) < 2e-3);
    }
}

TEST_CASE("A slab between clip planes that is thinner than a voxel is projected as what it holds",
          "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(16), glm::ivec3(0), [](const glm::ivec3& i) { return 0.05 * i.z; });
  ResolvedScene scene = projectionScene(Mode::mip, orthographicCamera({7.5, 7.5, 60}, {7.5, 7.5, 7.5}, 12, 8));
  scene.camera.up = {0, 1, 0};
  scene.clipBox = Box{{-50, -50, 6.3}, {50, 50, 6.6}};
  for (const Mode mode : kValueModes) {
    scene.mode = mode;
    const double expected = 0.05 * (mode == Mode::mip ? 6.6 : mode == Mode::minip ? 6.3 : 6.45);
    const Picture picture = valuePicture(grid, scene, 1);
    for (const float value : layerOf(picture, "value").pixels) CHECK(value == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("Pixels whose rays meet nothing but background are transparent, and others opaque", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobs();
  ResolvedScene scene = projectionScene(Mode::mip, orthographicCamera({30, 22, 40}, kSmallCentre, 60, 32));
  const Picture picture = valuePicture(grid, scene);
  scene.background = glm::dvec3(0.2, 0.3, 0.4);
  const Picture behind = valuePicture(grid, scene);
  const Image& values = layerOf(picture, "value");
  int empty = 0, seen = 0;
  for (std::size_t i = 0; i < values.pixels.size(); ++i) {
    const float* const colour = &picture.colour.pixels[4 * i];
    const bool isEmpty = values.pixels[i] == 0;
    ++(isEmpty ? empty : seen);
    CHECK(colour[3] == (isEmpty ? 0.0f : 1.0f));
    CHECK(behind.colour.pixels[4 * i + 3] == 1.0f);
    CHECK(behind.colour.pixels[4 * i] == (isEmpty ? 0.2f : colour[0]));
    // The window is from 0 to 1, and the function is white.
    if (!isEmpty) CHECK(linearToSrgb(colour[0]) == Approx(values.pixels[i]).margin(1e-6));
  }
  CHECK(empty > 100);
  CHECK(seen > 50);
}

TEST_CASE("A pixel of several samples has the mean of their values", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobs();
  ResolvedScene scene = projectionScene(Mode::average, orthographicCamera({30, 22, 40}, kSmallCentre, 30, 24));
  const Image one = layerOf(valuePicture(grid, scene, 8), "value");
  scene.sampling.pixelSamples = 5;
  const Image several = layerOf(valuePicture(grid, scene, 8), "value");
  CHECK(rmsDifference(several, layerOf(renderReference(grid, scene), "value")) < 2e-4);
  CHECK(rmsDifference(several, one) > 5e-4);
}

TEST_CASE("An X-ray is what emission leaves of the light behind it", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobs();
  ResolvedScene scene = projectionScene(Mode::xray, orthographicCamera({30, 22, 40}, kSmallCentre, 30, 32));
  const Image through = layerOf(valuePicture(grid, scene, 4), "value");
  const Image exact = layerOf(renderReference(grid, scene), "value");
  CHECK(meanOf(exact) < 0.9);
  // The value counts as linear between samples, and has kinks at voxels.
  CHECK(rmsDifference(through, exact) < 5e-4);
  scene.mode = Mode::integrate;
  const Image colour = valuePicture(grid, scene, 4).colour;
  for (std::size_t i = 0; i < through.pixels.size(); ++i) CHECK(through.pixels[i] == 1 - colour.pixels[4 * i + 3]);
}

TEST_CASE("A renderer goes from mode to mode", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobs();
  const ResolvedScene first = projectionScene(Mode::integrate, orthographicCamera({30, 22, 40}, kSmallCentre, 30, 24));
  const auto bricks = cutGrid(grid, BrickOptions{.interior = 16, .apron = kGradientApron}, true);
  RayRenderer renderer(*bricks, first);
  for (const Mode mode : {Mode::mip, Mode::integrate, Mode::xray, Mode::isosurface, Mode::average, Mode::integrate}) {
    ResolvedScene scene = first;
    scene.mode = mode;
    if (mode == Mode::isosurface) scene.surfaces = {surfaceAt(0.4)};
    renderer.setScene(scene);
    INFO("mode " << modeName(mode));
    CHECK(maxDifference(renderer.render().colour, RayRenderer(*bricks, scene).render().colour) == 0);
  }
}
