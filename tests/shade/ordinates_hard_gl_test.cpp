// Hard cases of light by ordinates. The room check tests that bricks change nothing far from the origin and on faces.
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "shade/hard_case.h"
#include "shade/ordinates_scene.h"
#include "support/closed_forms.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/scene/lights.h"

using namespace umbrick;

namespace {

ResolvedScene eightDirections(const TransferFunction& transfer, const Camera& camera, double spacing,
                              double theta = 1) {
  return ordinatesScene(transfer, camera, spacing, theta, 8);
}

void setLights(ResolvedScene& scene, const std::vector<ListedDirection>& list, LightFrame frame = LightFrame::view) {
  scene.model = Model::lights;
  scene.lights = {{frame, ListedLight{list}}};
}

// Compares with the reference of the same directions, at the scene's spacing and at half of it, with window texels as
// large as slabs. The error is of first order at least (see ordinates_convergence_gl_test), so that the remaining error
// is no more than what the halving changed. Slices that happen to be better than their order, the tolerance of the
// reference and the table are allowed for by `floor`.
void checkAgainstDirections(const GlContext& context, const ScalarGrid& grid, ResolvedScene scene, double floor = 1e-3,
                            double changes = 1) {
  ReferenceOptions options;
  options.tolerance = 1e-3;
  options.lights = lightDirections(scene, scene.occlusion.ordinates.directions);
  const Image exact = renderReference(grid, scene, options).colour;
  scene.occlusion.ordinates.scale = shortestVoxelEdge(grid.indexToWorld()) / scene.sampling.spacing;
  const Image coarse = renderGrid(context, grid, scene).colour;
  scene.sampling.spacing *= 0.5;
  scene.occlusion.ordinates.scale *= 2;
  const Image fine = renderGrid(context, grid, scene).colour;
  const double change = rmsDifference(coarse, fine), rest = rmsDifference(fine, exact);
  ResolvedScene bright = scene;
  bright.model = Model::emission;
  const double shadow = rmsDifference(renderGrid(context, grid, bright).colour, exact);
  INFO("change by halving the spacing " << change << ", left to the reference " << rest << ", shadow " << shadow);
  CHECK(largestAlpha(exact) > 0.05);
  CHECK(shadow > 10 * rest);  // there is something to compare
  CHECK(change < 0.02);
  CHECK(rest < changes * change + floor);
}

}  // namespace

// The closed form is explained in ordinates_gl_test.
TEST_CASE("Slabs of optical depths from 1e-8 to 1e4 scatter what they should, by ordinates", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double d = 0.5, depth = 10;
  for (const double slab : {1e-8, 1e-5, 1e-3, 0.1, 0.49, 0.51, 1.0, 10.0, 1e4}) {
    for (const glm::dvec3& towards : {glm::dvec3(0, 0, 1), glm::dvec3(0.6, 0, 0.8)}) {
      Camera camera = orthographicCamera({16, 16, 40}, {16, 16, 0}, 8, 4);
      ResolvedScene scene = ordinatesScene(ramp(slab / d), camera, d, 0, 1);
      setLights(scene, {{towards}});
      scene.clipPlanes = {{0, 0, -1, 30}, {0, 0, 1, depth - 30}};
      const FieldBricks volume =
          fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-16, -16, 0), glm::ivec3(47, 47, 47)});
      const double both = 1 + 1 / towards.z;
      const double expected = -std::expm1(-slab * depth / d * both) / both;
      const double found = *renderPicture(*context, volume, scene, kLayers).visibility.at(2, 2);
      INFO("optical depth of a slab " << slab << ", towards " << towards.x << ": " << found << " for " << expected);
      CHECK(found == Approx(expected).epsilon(1e-5));  // slabFactor is exact to 1e-6, and 20 slabs are rounded
    }
  }
}

TEST_CASE("Media as solid as numbers allow are lit in front and dark behind, at any angle", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const auto ball = [](const glm::ivec3& i) { return glm::length(glm::dvec3(i) - kSmallCentre) < 7 ? 1.0 : 0.0; };
  for (const double sigma_t : {1e6, 1e30, 1e38, 1e300})
    for (const double theta : {0.0, 1.0, 89.9 * kDegree})
      for (const int directions : {1, 16})
        for (const int bits : {32, 16})
          for (const Camera& camera : smallCameras(20)) {
            INFO("sigma_t " << sigma_t << ", theta " << theta << ", directions " << directions << ", bits " << bits
                            << ", perspective " << (camera.projection == Projection::perspective));
            ResolvedScene scene = ordinatesScene(ramp(sigma_t), camera, 0.5, theta, directions);
            scene.occlusion.bits = bits;
            // Only the front half of the ball is compared, which no part of the ball shades.
            const glm::dvec3 forward = cameraFrame(camera).forward;
            scene.clipPlanes = {{forward, -glm::dot(forward, kSmallCentre)}};
            const FieldBricks volume = fieldFor(scene, ball, {glm::ivec3(0), glm::ivec3(23)});
            const Picture picture = renderPicture(*context, volume, scene, kLayers);
            CHECK(allWithin(picture.colour, 0, 1));
            CHECK(allWithin(picture.visibility, 0, 1));
            CHECK(picture.colour.at(10, 10)[3] == Approx(1).epsilon(1e-6));
            CHECK(picture.colour.at(0, 10)[3] == 0);
            // Only the first slab is seen, and nothing is in front of it; it shades itself: d_e / (d_e + d_k), with the
            // mean path of all directions.
            double weighted = 0;
            for (const LightDirection& light : lightDirections(scene, directions))
              weighted += light.radiance.r / (1 - 1 / glm::dot(light.direction, cameraFrame(camera).forward));
            const double stretch = viewRay(camera, 10.5, 10.5).stretch();
            CHECK(picture.visibility.at(10, 10)[0] == Approx(stretch / (stretch + 1 / weighted - 1)).epsilon(1e-4));
          }
}

// A window is multiplied 10 000 times and may drift. Single precision rounds each time by 6e-8 of it, 16 bits by
// half of 1/65535, at worst always in the same direction: then light does not fall at all when a slab takes less
// than half a step.
TEST_CASE("Windows that 10 000 slices have multiplied are off by half a step per slice at most", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const double depth = 20;
  for (const double whole : {0.05, 2.3})
    for (const int slices : {100, 10'000}) {
      const double d = depth / slices;
      ResolvedScene scene =
          eightDirections(ramp(whole / depth), orthographicCamera({12, 12, 20.5 + d}, {12, 12, 0}, 4, 2), d);
      setLights(scene, {{glm::dvec3(0.28, 0, 0.96)}});
      scene.clipPlanes = {{0, 0, -1, 20.5}, {0, 0, 1, -0.5}};
      scene.occlusion.ordinates.scale = 1;
      const FieldBricks volume =
          fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-8), glm::ivec3(31)});
      const double both = 1 + 1 / 0.96, exact = -std::expm1(-whole * both) / both;
      const double rounding = 8 * kFloatRounding * slices + 2e-6 * whole / slices;
      for (const int bits : {32, 16}) {
        scene.occlusion.bits = bits;
        const Picture picture = renderPicture(*context, volume, scene, kLayers);
        const double error = *picture.visibility.at(1, 1) - exact;
        INFO("optical depth " << whole << ", slices " << slices << ", bits " << bits << ": error " << error);
        CHECK(std::abs(error) < rounding + (bits == 16 ? 0.5 / 65535 * slices : 0));
        // Slabs take 5e-6 each, and the light sees none of them.
        if (bits == 16 && whole == 0.05 && slices == 10'000) {
          const double unshadowed = -std::expm1(-whole);
          CHECK(*picture.visibility.at(1, 1) == Approx(unshadowed).epsilon(1e-3));
        }
      }
    }
}

// Of 24 directions in 89.9 degrees the steepest move by 9 to 44 units per unit of depth, and meet the medium once in as
// many slabs: too rarely to show an order before slabs are a tenth as thick. Measured: 2.9 times the change remains.
TEST_CASE("Apertures of 0 and 89.9 degrees, one direction and many, match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled({24, 24, 24}, {0, 0, 0}, smallBlobs);
  for (const Camera& camera : smallCameras(16))
    for (const auto& [theta, directions] :
         {std::pair(0.0, 4), std::pair(1.5, 1), std::pair(89.9, 4), std::pair(89.9, 24)}) {
      INFO("theta " << theta << ", directions " << directions << ", perspective "
                    << (camera.projection == Projection::perspective));
      checkAgainstDirections(*context, grid, ordinatesScene(ramp(0.6), camera, 0.5, theta * kDegree, directions), 1e-3,
                             directions == 24 ? 4 : 1);
    }
}

// Where light nearly grazes the slices, a slab takes nearly all of it, and no light comes from anywhere else.
TEST_CASE("Light at a grazing angle is blocked by what is beside a point, or not at all", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled({24, 24, 24}, {0, 0, 0}, smallBlobs);
  for (const Camera& camera : smallCameras(24))
    for (const double towards : {1e-2, 1e-4, 1e-9, 1e-300}) {
      INFO("towards the viewer " << towards << ", perspective " << (camera.projection == Projection::perspective));
      ResolvedScene scene = eightDirections(ramp(0.6), camera, 0.5);
      setLights(scene, {{glm::dvec3(0.8, 0.6, towards)}});
      const Picture picture = renderGrid(*context, grid, scene, kLayers);
      CHECK(allWithin(picture.colour, 0, 1));
      CHECK(allWithin(picture.visibility, 0, 1));
      double brightest = 0;
      for (const float v : picture.visibility.pixels) brightest = std::max(brightest, static_cast<double>(v));
      // Through a slab of 0.5 the path is 0.5 / towards: everything is dark except for a rim of the blobs.
      CHECK(brightest < 30 * towards + 1e-3);
    }
}

// These are bricks of a field, since OpenVDB takes no voxels below 1.5e-5 units. Roundings are as in
// hard_transforms_gl_test.
TEST_CASE("Huge and tiny worlds, by ordinates, look like one of unit size", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const IndexBox voxels{glm::ivec3(0), glm::ivec3(23)};
  for (const Camera& camera : smallCameras()) {
    const ResolvedScene scene = eightDirections(ramp(0.6), camera, 0.5);
    const Picture unit = renderPicture(*context, fieldFor(scene, smallBlobs, voxels), scene, kLayers);
    for (const double scale : {0x1p-20, 1e-6, 1e6, 0x1p40, 1e-12}) {
      INFO("scale " << scale << ", perspective " << (camera.projection == Projection::perspective));
      ResolvedScene other = scene;
      other.camera.eye *= scale;
      other.camera.lookAt *= scale;
      other.camera.viewHeight *= scale;
      other.sampling.spacing *= scale;
      other.transfer = scene.transfer.scaled(1 / scale);
      FieldOptions options;
      options.indexToWorld = glm::scale(glm::dmat4(1), glm::dvec3(scale));
      const Picture picture = renderPicture(*context, fieldFor(other, smallBlobs, voxels, options), other, kLayers);
      CHECK(picture.stats.windowTexel == Approx(scale * unit.stats.windowTexel));
      CHECK(layersDifference(picture, unit) < 2e-5);
    }
  }
}

TEST_CASE("A grid 1e6 voxels from the origin, by ordinates, looks like one at the origin", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::ivec3 far(1'000'000, -1'000'000, 1'000'000);  // a multiple of the bricks' edge
  const IndexBox voxels{glm::ivec3(0), glm::ivec3(23)};
  for (const glm::dmat4& transform : {glm::dmat4(1), crookedTransform()})
    for (Camera camera : smallCameras()) {
      INFO("crooked " << (transform != glm::dmat4(1)) << ", perspective "
                      << (camera.projection == Projection::perspective));
      FieldOptions options;
      options.indexToWorld = transform;
      const glm::dvec3 centre(transform * glm::dvec4(kSmallCentre, 1));
      camera.eye += centre - camera.lookAt;
      camera.lookAt = centre;
      ResolvedScene scene = eightDirections(ramp(0.6), camera, 0.5);
      scene.clipPlanes = {{0.3, -0.5, -0.8, 4 - glm::dot(glm::dvec3(0.3, -0.5, -0.8), centre)}};
      const Picture here = renderPicture(*context, fieldFor(scene, smallBlobs, voxels, options), scene, kLayers);
      const glm::dvec3 moved = glm::dmat3(transform) * glm::dvec3(far);
      scene.camera.eye += moved;
      scene.camera.lookAt += moved;
      scene.clipPlanes[0].w -= glm::dot(glm::dvec3(scene.clipPlanes[0]), moved);
      const auto farBlobs = [&](const glm::ivec3& i) { return smallBlobs(i - far); };
      const FieldBricks there = fieldFor(scene, farBlobs, {voxels.min + far, voxels.max + far}, options);
      const Picture picture = renderPicture(*context, there, scene, kLayers);
      REQUIRE(largestAlpha(here.colour) > 0.5);
      CHECK(layersDifference(here, picture) < 2e-5);  // see hard_transforms_gl_test
    }
}

TEST_CASE("Grids in any place and shape, by ordinates, match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled({24, 24, 24}, {0, 0, 0}, smallBlobs);
  const std::pair<std::string, glm::dmat4> transforms[] = {
      {"anisotropic", glm::scale(glm::dmat4(1), glm::dvec3(0.7, 2, 1))},
      {"sheared", glm::dmat4(1, 0, 0, 0, 0.7, 1, 0, 0, -0.4, 0.9, 1, 0, 0, 0, 0, 1)},
      {"mirrored", glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1))},
      {"small", glm::scale(glm::dmat4(1), glm::dvec3(1.6e-5))},
      {"all of it, and moved", crookedTransform()}};
  Camera base;
  base.width = base.height = 16;
  Projection projection = Projection::orthographic;
  for (const auto& [name, transform] : transforms) {
    projection = projection == Projection::perspective ? Projection::orthographic : Projection::perspective;
    INFO(name << ", perspective " << (projection == Projection::perspective));
    const ScalarGrid placed = withTransform(grid, transform);
    base.projection = projection;
    const double edge = shortestVoxelEdge(transform);
    const double volume = std::cbrt(std::abs(glm::determinant(glm::dmat3(transform))));
    checkAgainstDirections(
        *context, placed,
        ordinatesScene(ramp(0.5 / volume), orbitCamera(placed.worldBounds(), 0.6, 0.4, base), 0.5 * edge, 1, 6));
  }
}

TEST_CASE("A camera in the medium and a wide field of view, by ordinates, match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({20, 20, 20});
  for (const glm::dvec3& forward : {glm::dvec3(0, 0, 1), glm::dvec3(-0.4, 0.7, -0.2)})
    for (const bool perspective : {false, true}) {
      if (!perspective && forward.z == 1) continue;
      const glm::dvec3 eye(9.2, 10.9, 8.1);
      INFO("forward " << forward.x << ", perspective " << perspective);
      checkAgainstDirections(*context, grid,
                             ordinatesScene(ramp(0.2),
                                            perspective ? perspectiveCamera(eye, eye + forward, 1.3, 12)
                                                        : orthographicCamera(eye, eye + forward, 12, 12),
                                            0.5, 1, 6));
    }
  for (const glm::dvec3& eye : {glm::dvec3(9, 10, 8)}) {
    INFO("150 degrees from z = " << eye.z);
    checkAgainstDirections(
        *context, grid,
        ordinatesScene(ramp(0.2), perspectiveCamera(eye, eye - glm::dvec3(0.1, 0.2, 1), 150 * kDegree, 12), 0.25, 1,
                       6));
  }
  const glm::dvec3 centre(9.5);
  checkAgainstDirections(
      *context, grid,
      ordinatesScene(ramp(0.2),
                     perspectiveCamera(centre + 2600.0 * glm::normalize(glm::dvec3(1, -2, 3)), centre, kDegree, 12),
                     0.5, 1, 6));
}

TEST_CASE("From inside an opaque brick the eye sees its first slab, in its own light", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const bool perspective : {false, true}) {
    const glm::dvec3 eye(20.3, 19.1, 21.7);
    const Camera camera = perspective ? perspectiveCamera(eye, eye - glm::dvec3(0.2, 0.3, 1), 1.2, 16)
                                      : orthographicCamera(eye, eye - glm::dvec3(0.2, 0.3, 1), 8, 16);
    ResolvedScene scene = ordinatesScene(ramp(1e5), camera, 0.5, 0, 1);
    const FieldBricks volume = fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(0), glm::ivec3(47)});
    const Picture picture = renderPicture(*context, volume, scene, kLayers);
    double worst = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const double stretch = viewRay(camera, x + 0.5, y + 0.5).stretch();
        worst = std::max({worst, std::abs(1.0 - picture.colour.at(x, y)[3]),
                          std::abs(stretch / (stretch + 1) - picture.visibility.at(x, y)[0])});
      }
    CHECK(worst < 1e-5);
  }
}

// Paths and lattice depend on the view axis, not on the picture and its edges.
TEST_CASE("One-pixel and narrow images, by ordinates, are cut-outs of larger ones", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 30, 30});
  for (const bool perspective : {false, true}) {
    const Camera large = perspective ? perspectiveCamera({40, 30, 50}, glm::dvec3(14.5), 0.7, 27)
                                     : orthographicCamera({40, 30, 50}, glm::dvec3(14.5), 40, 27);
    ResolvedScene scene = eightDirections(ramp(0.3), large, 0.5);
    const Image whole = renderGrid(*context, grid, scene).colour;
    REQUIRE(largestAlpha(whole) > 0.9);
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(27, 1), glm::ivec2(1, 27), glm::ivec2(3, 9)}) {
      INFO("size " << size.x << " x " << size.y << ", perspective " << perspective);
      scene.camera.width = size.x;
      scene.camera.height = size.y;
      scene.camera.viewHeight = large.viewHeight * size.y / 27;
      scene.camera.fov = 2 * std::atan(std::tan(0.5 * large.fov) * size.y / 27);
      const Image part = renderGrid(*context, grid, scene).colour;
      double worst = 0;
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          for (int c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(static_cast<double>(part.at(x, y)[c]) -
                                             whole.at(x + (27 - size.x) / 2, y + (27 - size.y) / 2)[c]));
      CHECK(worst < 2e-5);  // see hard_cameras_gl_test
    }
  }
}

TEST_CASE("What a grid holds, nothing, one voxel, tiles or fog, is lit as the reference says", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ResolvedScene nothing = eightDirections(ramp(1), orthographicCamera({0, 0, 9}, {0, 0, 0}, 10, 8), 0.5);
  const Picture empty = renderGrid(*context, makeVoxels({}), nothing, kLayers);
  CHECK(maxDifference(empty.colour, Image(8, 8)) == 0);
  CHECK(maxDifference(empty.visibility, Image(8, 8, 1)) == 0);
  ResolvedScene beside = eightDirections(ramp(1), orthographicCamera({0, 0, 9}, {0, 0, 0}, 4, 8), 0.5);
  CHECK(maxDifference(renderGrid(*context, makeVoxels({{{30, 0, 0}, 1.0f}}), beside).colour, Image(8, 8)) == 0);
  beside.camera = orthographicCamera({0, 0, -9}, {0, 0, -20}, 100, 8);  // everything is behind the eye
  CHECK(maxDifference(renderGrid(*context, makeVoxels({{{0, 0, 0}, 1.0f}}), beside).colour, Image(8, 8)) == 0);

  const openvdb::FloatGrid::Ptr tiles = openvdb::FloatGrid::create(0);
  tiles->tree().addTile(1, openvdb::Coord(0, 0, 0), 1, true);
  tiles->tree().addTile(1, openvdb::Coord(8, 0, 0), 0.5f, false);
  tiles->tree().addTile(1, openvdb::Coord(-16, 8, 16), 0.7f, true);
  const auto soft = [](const glm::ivec3& p) { return 5 - 0.2 * p.x * std::sin(0.3 * p.y); };
  struct Volume {
    std::string name;
    ScalarGrid grid;
    TransferFunction transfer;
    Box bounds;
    double spacing;
  };
  const Box softBounds{glm::dvec3(-10, 3, 1), glm::dvec3(11, 22, 18)};
  const Volume volumes[] = {
      {"one voxel", makeVoxels({{{3, -2, 7}, 1.0f}}), ramp(1.5), {glm::dvec3(2, -3, 6), glm::dvec3(4, -1, 8)}, 0.25},
      {"tiles", makeGrid(tiles), ramp(0.2), {glm::dvec3(-17, -1, -1), glm::dvec3(16, 16, 24)}, 0.5},
      {"a level set",
       makeSphereLevelSet(12, 1, {3, 4, -5}),
       ramp(0.1, 0, -2),
       {glm::dvec3(-10, -9, -18), glm::dvec3(16, 17, 8)},
       0.5},
      {"a background that is not seen", makeFilled({20, 18, 16}, {-9, 4, 2}, soft, 5), ramp(0.1, 5, 1), softBounds,
       0.5},
      {"fog of background", makeFilled({20, 18, 16}, {-9, 4, 2}, soft, 5), ramp(0.1, 1, 5), softBounds, 0.5}};
  Camera base;
  base.width = base.height = 16;
  Projection projection = Projection::orthographic;
  for (const Volume& volume : volumes) {
    projection = projection == Projection::perspective ? Projection::orthographic : Projection::perspective;
    INFO(volume.name << ", perspective " << (projection == Projection::perspective));
    base.projection = projection;
    checkAgainstDirections(*context, volume.grid,
                           eightDirections(volume.transfer, orbitCamera(volume.bounds, 0.6, 0.4, base), volume.spacing),
                           1.5e-3);
  }
}

TEST_CASE("Lights without radiance and maps that are dark in front give opacity and no light", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = eightDirections(ramp(0.6), smallCameras()[1], 0.5);
  const FieldBricks volume = fieldFor(scene, smallBlobs, {glm::ivec3(0), glm::ivec3(23)});
  const Picture lit = renderPicture(*context, volume, scene, kLayers);
  EnvironmentLight dark;
  dark.image = std::make_shared<const Image>(8, 4, 3);
  for (const LightSource& source : {LightSource{LightFrame::view, ConeLight{{0, 0, 1}, 0.5, glm::dvec3(0)}},
                                    LightSource{LightFrame::view, ListedLight{{{{0, 0, 1}, 0, glm::dvec3(1)}}}},
                                    LightSource{LightFrame::view, dark}}) {
    scene.model = Model::lights;
    scene.lights = {source};
    const Picture picture = renderPicture(*context, volume, scene, kLayers);
    for (std::size_t i = 0; i < picture.colour.pixels.size(); ++i)
      if (i % 4 == 3)
        REQUIRE(picture.colour.pixels[i] == lit.colour.pixels[i]);
      else
        REQUIRE(picture.colour.pixels[i] == 0);
  }
}

// Where slices are and how paths are rounded depends on distances from the eye, the directions as the camera sees them
// and the size of a texel, none of which a moving camera changes. The steps are 1 / 1024 of a step of the path: a jump
// would stay as it is, see continuity_gl_test.
//
// Lights of the world turn as the camera moves: then one path after another is rounded to another texel in one slice
// after another. Each jumps by a share of the light of one slab.
TEST_CASE("No step of the camera is so small that light by ordinates jumps", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled({24, 24, 24}, {0, 0, 0}, smallBlobs);
  const Box bounds{glm::dvec3(0), glm::dvec3(23)};
  const double step = 0.05 * kDegree;
  enum class Light { cone, view, world };
  for (const bool perspective : {false, true})
    for (const bool dolly : {false, true})
      for (const Light light : {Light::cone, Light::view, Light::world})
        for (const double scale : {0.0, 0.7}) {
          Camera base;
          base.width = base.height = 24;
          base.projection = perspective ? Projection::perspective : Projection::orthographic;
          const auto camera = [&](double i) {
            Camera moved = orbitCamera(bounds, 0.5 + (dolly ? 0 : i * step), 0.3, base);
            if (dolly) moved.eye += 0.05 * i * glm::normalize(moved.lookAt - moved.eye);
            return moved;
          };
          ResolvedScene scene = ordinatesScene(ramp(0.6), camera(0), 0.5, 0.8, 8);
          scene.bricks.interior = 8;
          scene.occlusion.ordinates.scale = scale;
          if (light != Light::cone) {
            const CameraFrame axes = cameraFrame(scene.camera);
            const glm::dmat3 toWorld =
                light == Light::view ? glm::dmat3(1) : glm::dmat3(axes.right, axes.up, -axes.forward);
            setLights(scene, {{toWorld * glm::dvec3(0.9, 0.1, 0.6)}, {toWorld * glm::dvec3(-0.4, -0.3, 0.7)}},
                      light == Light::view ? LightFrame::view : LightFrame::world);
          }
          const auto volume = bricksFor(grid, scene);
          SliceRenderer renderer(*context, *volume, scene);
          double largestStep = 0, jump = 0;
          for (int i = 0; i < 20; i += 10) {
            double from = i, to = i + 1;
            Image a = renderer.render(camera(from)).colour, b = renderer.render(camera(to)).colour;
            largestStep = std::max(largestStep, maxDifference(a, b));
            for (int halving = 0; halving < 10; ++halving) {
              const double middle = 0.5 * (from + to);
              Image m = renderer.render(camera(middle)).colour;
              const bool first = maxDifference(a, m) > maxDifference(m, b);
              (first ? to : from) = middle;
              (first ? b : a) = std::move(m);
            }
            jump = std::max(jump, maxDifference(a, b));
          }
          const bool steady = light != Light::world || dolly;
          INFO("perspective " << perspective << ", dolly " << dolly << ", light " << static_cast<int>(light)
                              << ", scale " << scale << ": largest step " << largestStep << ", largest jump " << jump);
          CHECK(largestStep > 2e-4);
          // One of two directions, or of eight, may jump by all that its slab takes where it is most solid.
          const double share = light == Light::cone ? 0.125 : 0.5;
          CHECK(jump < (steady ? 8 * largestStep / 1024 + 3e-5 : share * -std::expm1(-0.6 * 0.5 * 1.9)));
        }
}

// A wall along the view axis, one voxel thick, stands between the light and a floor. Windows sample it at the centres
// of their texels. With texels of a voxel its optical depth is right at any phase, as the tents of linear interpolation
// add up to one. Larger texels see it too thick in some phases and not at all in others, and as thick as it is on
// average over phases. The wall leaks then, on average the more the larger a texel is and at worst all of the light.
// This is why scale 0 takes texels of a voxel unless slabs are larger.
TEST_CASE("A wall thinner than a texel of the light windows leaks, at worst all of the light", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto field = [](const glm::ivec3& i) { return i.z == 4 || (i.x == 16 && i.z > 8 && i.z < 40) ? 1.0 : 0.0; };
  const double sigma_t = 4, tilt = 1;  // light moves as far to the right as up
  // This is the share of light that the wall lets through where light crosses it at 45 degrees: a tent's area, on
  // the way across.
  const double through = std::exp(-sigma_t * std::sqrt(2.0));
  std::vector<double> mean, most;
  for (const double scale : {0.25, 0.5, 1.0, 2.0}) {
    double sum = 0, largest = 0;
    const int phases = 8;
    for (int phase = 0; phase < phases; ++phase) {
      // The place is on the floor, 9 to 11 units to the left of the wall: all light there has crossed the
      // wall half-way up.
      const double x = 6 + phase / scale / phases;
      Camera camera = orthographicCamera({x, 16, 44.25}, {x, 16, 0}, 1, 2);
      camera.up = {0, 1, 0};
      ResolvedScene scene = ordinatesScene(ramp(sigma_t), camera, 0.5, 0, 1);
      scene.occlusion.ordinates.scale = scale;
      setLights(scene, {{glm::dvec3(tilt, 0, 1)}});
      const FieldBricks volume = fieldFor(scene, field, {glm::ivec3(-8, 0, 0), glm::ivec3(39, 31, 47)});
      const double shadowed = *renderPicture(*context, volume, scene, kLayers).visibility.at(1, 1);
      scene.clipPlanes = {{0, 0, -1, 7}};
      const double leak = shadowed / *renderPicture(*context, volume, scene, kLayers).visibility.at(1, 1);
      sum += leak / phases;
      largest = std::max(largest, leak);
    }
    mean.push_back(sum);
    most.push_back(largest);
  }
  INFO("behind the wall " << through << "; mean " << mean[0] << ' ' << mean[1] << ' ' << mean[2] << ' ' << mean[3]
                          << ", most " << most[0] << ' ' << most[1] << ' ' << most[2] << ' ' << most[3]);
  CHECK(most[0] > 0.9);  // all of the light, which a user must expect of texels so large
  CHECK(mean[0] > mean[1]);
  CHECK(mean[1] > mean[2]);
  CHECK(most[1] > 0.9);
  CHECK(most[2] == Approx(through).epsilon(1e-3));
  CHECK(most[3] == Approx(through).epsilon(1e-3));
}

TEST_CASE("Light windows that no driver has room for are refused with the reason", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = eightDirections(ramp(0.6), smallCameras()[0], 0.5);
  const FieldBricks volume = fieldFor(scene, smallBlobs, {glm::ivec3(0), glm::ivec3(23)});
  scene.occlusion.ordinates.scale = 2000;
  CHECK_THAT(complaint<InvalidArgument>([&] { renderPicture(*context, volume, scene); }), Catch::Contains("scale"));
  scene.occlusion.ordinates.scale = 0;
  std::vector<ListedDirection> many(5000, {{0.1, 0.2, 1}, 1.0 / 5000, glm::dvec3(1)});
  setLights(scene, many);
  CHECK_THAT(complaint<InvalidArgument>([&] { renderPicture(*context, volume, scene); }),
             Catch::Contains("directions"));
}
