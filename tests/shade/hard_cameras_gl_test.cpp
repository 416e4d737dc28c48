// Hard cases of the camera and of the picture's size. Tested elsewhere: chords from inside a homogeneous box and beyond
// a near distance (emission_gl_test), light in a medium wider than the image (occlusion_gl_test), slabs thinner than a
// slice that clip planes leave (emission_gl_test, occlusion_gl_test), images that are not square (check), views along
// planes of the grid (hard_transforms_gl_test).
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "shade/hard_case.h"

using namespace umbrick;

namespace {

Camera withSize(Camera camera, int width, int height) {
  camera.width = width;
  camera.height = height;
  return camera;
}

}  // namespace

TEST_CASE("A camera inside a brick sees what is in front of it, as the reference does", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 30, 30});
  for (const glm::dvec3& eye : {glm::dvec3(13.2, 14.9, 11.1), glm::dvec3(15.5, 15.5, 15.5), glm::dvec3(16, 9, 3)})
    for (const glm::dvec3& forward : {glm::dvec3(0, 0, 1), glm::dvec3(-0.4, 0.7, -0.2)}) {
      INFO("eye " << eye.x << ' ' << eye.y << ' ' << eye.z << ", forward " << forward.x);
      checkAgainstReference(*context, grid, plainScene(ramp(0.2), perspectiveCamera(eye, eye + forward, 1.3, 24), 0.5));
      for (const Model model : {Model::emission, Model::cone}) {
        ResolvedScene scene = plainScene(ramp(0.2), orthographicCamera(eye, eye + forward, 12, 24), 0.5);
        scene.model = model;
        scene.occlusion.aperture = 0;
        checkAgainstReference(*context, grid, scene);
      }
    }
}

TEST_CASE("A near distance through the volume cuts it, light included, as the reference does", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 30, 30});
  // The near distance also lies between slices, and where only a last sliver is left.
  for (const double distance : {12.0, 22.13, 39.9}) {
    INFO("near " << distance);
    ResolvedScene scene = plainScene(ramp(0.3), perspectiveCamera({15, 20, 50}, {15, 14, 10}, 0.6, 24), 0.5);
    scene.camera.nearDistance = distance;
    checkAgainstReference(*context, grid, scene);
    scene.camera = orthographicCamera({15, 20, 50}, {15, 14, 10}, 24, 24);
    scene.camera.nearDistance = distance;
    scene.model = Model::cone;
    scene.occlusion.aperture = 0;
    checkAgainstReference(*context, grid, scene);
  }
}

// At 1 degree rays are nearly parallel and 57 times as long as the picture is high. At 150 degrees the rays
// at the corners are 5.4 times as long per slice as the central one, and a slab of one voxel's depth has to
// reach through that.
TEST_CASE("Fields of view of 1 and 150 degrees match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 30, 30});
  const glm::dvec3 centre(14.5);
  ResolvedScene scene = plainScene(
      ramp(0.2), perspectiveCamera(centre + 2600.0 * glm::normalize(glm::dvec3(1, -2, 3)), centre, 1 * kDegree, 32),
      0.5);
  checkAgainstReference(*context, grid, scene);
  for (const glm::dvec3& eye : {glm::dvec3(14, 15, 33), glm::dvec3(14, 15, 12)}) {
    scene.camera = perspectiveCamera(eye, eye - glm::dvec3(0.1, 0.2, 1), 150 * kDegree, 32);
    scene.sampling.spacing = 0.25;
    checkAgainstReference(*context, grid, scene, 2e-5, 1e-2);
  }
  // In a wide view light is carried towards the edges of the image: in a homogeneous half-space V is that of the
  // slabs in front.
  ResolvedScene cone = plainScene(ramp(0.1), perspectiveCamera({16, 16, 30.2}, {16, 16, 0}, 150 * kDegree, 32), 0.5);
  cone.model = Model::cone;
  cone.sampling.quadrature = Quadrature::midpoint;
  const FieldBricks wide =
      fieldFor(cone, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-128, -128, -16), glm::ivec3(159, 159, 47)});
  cone.clipPlanes = {{0, 0, 1, -20.2}};  // depths 0 to 10
  const Picture picture = renderPicture(*context, wide, cone, kLayers);
  double worst = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double stretch = viewRay(cone.camera, x + 0.5, y + 0.5).stretch();
      double through = 1, light = 1, visibility = 0;
      for (int slab = 0; slab < 20; ++slab) {
        visibility += through * light * -std::expm1(-0.05 * stretch);
        through *= std::exp(-0.05 * stretch);
        light *= std::exp(-0.05);
      }
      worst = std::max(worst, std::abs(picture.visibility.at(x, y)[0] - visibility));
    }
  CHECK(worst < 20 * 10 * kFloatRounding);  // a few roundings for each slab
}

// Pixels are points on rays: a pixel of a small image equals the pixel of a larger one that has the same ray.
TEST_CASE("One-pixel and narrow images are cut-outs of larger ones", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 30, 30});
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    // The large image has 27 x 27 pixels; smaller images show its middle row, column and pixel.
    Camera large = projection == Projection::perspective ? perspectiveCamera({40, 30, 50}, glm::dvec3(14.5), 0.7, 27)
                                                         : orthographicCamera({40, 30, 50}, glm::dvec3(14.5), 40, 27);
    ResolvedScene scene = plainScene(ramp(0.3), large, 0.5);
    const Image whole = renderGrid(*context, grid, scene).colour;
    REQUIRE(largestAlpha(whole) > 0.9);
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(27, 1), glm::ivec2(1, 27), glm::ivec2(3, 9)}) {
      INFO("size " << size.x << " x " << size.y << ", perspective " << (projection == Projection::perspective));
      scene.camera = withSize(large, size.x, size.y);
      scene.camera.viewHeight = large.viewHeight * size.y / 27;
      scene.camera.fov = 2 * std::atan(std::tan(0.5 * large.fov) * size.y / 27);
      const Image part = renderGrid(*context, grid, scene).colour;
      double worst = 0;
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          for (int c = 0; c < 4; ++c)
            worst = std::max(worst, static_cast<double>(std::abs(
                                        part.at(x, y)[c] - whole.at(x + (27 - size.x) / 2, y + (27 - size.y) / 2)[c])));
      // Screen points are rounded to 6e-8 of other sizes. This is 3e-6 voxels, where values change by up to
      // 0.2 a voxel.
      CHECK(worst < 2e-5);
    }
  }
}

// The buffers of one pixel still carry light: every tap reads that pixel.
TEST_CASE("In images of any shape light in a wide medium falls as it should", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.2, d = 0.5;
  for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(1, 33), glm::ivec2(50, 5), glm::ivec2(7, 5)})
    for (const bool perspective : {false, true}) {
      const Camera camera = perspective ? perspectiveCamera({16, 16, 40}, {16, 16, 0}, 0.1, 8)
                                        : orthographicCamera({16, 16, 40}, {16, 16, 0}, 1, 8);
      ResolvedScene scene = plainScene(ramp(sigma_t), withSize(camera, size.x, size.y), d);
      scene.model = Model::cone;
      scene.clipPlanes = {{0, 0, -1, 20}, {0, 0, 1, -10}};  // depths 20 to 30: 20 whole slabs
      const FieldBricks volume =
          fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-16, -16, 0), glm::ivec3(47, 47, 31)});
      for (const int bits : {16, 32})
        for (const int passes : {1, 2}) {
          INFO("size " << size.x << " x " << size.y << ", bits " << bits << ", passes " << passes << ", perspective "
                       << perspective);
          scene.occlusion.bits = bits;
          scene.occlusion.dos.passes = passes;
          const Picture picture = renderPicture(*context, volume, scene, kLayers);
          double worst = 0;
          for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
              const double tau = sigma_t * d * viewRay(scene.camera, x + 0.5, y + 0.5).stretch();
              double visibility = 0;
              for (int slab = 0; slab < 20; ++slab)
                visibility += std::exp(-slab * (tau + sigma_t * d)) * -std::expm1(-tau);
              worst = std::max(worst, std::abs(picture.visibility.at(x, y)[0] - visibility));
            }
          CHECK(worst < (bits == 16 ? 20 * 1.5 * std::exp2(-16) : 20 * 10 * kFloatRounding));
        }
    }
}

// A plate of one layer of voxels is a tent of base 2. Tents at equal distances of 1 add up to 1 everywhere, so slices
// that are 1/k voxels apart, or segments of that length, see the whole plate at any phase.
TEST_CASE("A plate thinner than a slab has its whole opacity at any phase of the slices", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 1.3;
  const ScalarGrid plate = makeFilled({24, 24, 1}, {0, 0, 5}, [](const glm::ivec3&) { return 1.0; });
  struct Slabs {
    double spacing;
    int segments;
  };
  for (const auto& [spacing, segments] : {Slabs{0.5, 1}, Slabs{1, 1}, Slabs{2, 2}, Slabs{4, 4}, Slabs{4, 8}})
    for (const double phase : {0.0, 0.13, 0.5, 0.77})
      for (const Model model : {Model::emission, Model::cone}) {
        INFO("spacing " << spacing << ", segments " << segments << ", phase " << phase << ", cone "
                        << (model == Model::cone));
        Camera camera = orthographicCamera({12, 12, 20 + phase}, {12, 12, 0}, 16, 9);
        camera.up = {0, 1, 0};
        ResolvedScene scene = plainScene(ramp(sigma_t), camera, spacing);
        scene.model = model;
        scene.sampling.segments = segments;
        const Picture picture = renderGrid(*context, plate, scene, kLayers);
        const double alpha = -std::expm1(-sigma_t);
        // The ramps are linear in value, so that means of the table are exact, except for a few roundings.
        CHECK(std::abs(picture.colour.at(4, 4)[3] - alpha) < 5e-6);
        CHECK(std::abs(picture.colour.at(0, 8)[3] - alpha) < 5e-6);
        // V is the light in front of each slab: it falls no further than through the plate.
        const double visibility = picture.visibility.at(4, 4)[0];
        CHECK(visibility <= alpha + 1e-6);
        if (model == Model::cone) CHECK(visibility >= 0.5 * -std::expm1(-2 * sigma_t) - 1e-6);
      }
}
