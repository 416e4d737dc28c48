// Tests light by ordinates with closed forms, laws, and a sweep on the CPU.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <functional>
#include <numbers>
#include <string>

#include "shade/grid_picture.h"
#include "shade/ordinates_scene.h"
#include "shade/ordinates_sweep.h"
#include "support/closed_forms.h"

using namespace umbrick;

namespace {

const IndexBox kWide{glm::ivec3(-64, -64, 0), glm::ivec3(95, 95, 63)};

TransferFunction tintedRamp(const glm::dvec3& albedo, double sigma_t) {
  return TransferFunction({{0, {albedo, 0}}, {1, {albedo, sigma_t}}});
}

ResolvedScene sixteenDirections(const TransferFunction& transfer, const Camera& camera, double spacing,
                                double theta = 1) {
  return ordinatesScene(transfer, camera, spacing, theta, 16);
}

LightSource lightFrom(const std::vector<ListedDirection>& list, LightFrame frame = LightFrame::view) {
  return {frame, ListedLight{list}};
}
LightSource lightFrom(const glm::dvec3& direction, const glm::dvec3& colour = glm::dvec3(1)) {
  return lightFrom(std::vector<ListedDirection>{{direction, 1, colour}});
}

void setLights(ResolvedScene& scene, const std::vector<LightSource>& lights) {
  scene.model = Model::lights;
  scene.lights = lights;
}

Camera straightCamera(bool perspective, double z, int size) {
  Camera camera = perspective ? perspectiveCamera({16, 16, z}, {16, 16, 0}, 0.7, size)
                              : orthographicCamera({16, 16, z}, {16, 16, 0}, 30, size);
  camera.up = {0, 1, 0};
  return camera;
}

// Texture coordinates are rounded to 6e-8 of some 50 texels, 3e-6 voxels, and places on the lattice of the light to as
// much of a texel. Values and shares differ by up to a quarter from voxel to voxel, and optical depths of slabs by as
// much, on each of some 80 slabs: 80 * 0.25 * 3e-6 at the very worst, and a third of that as a random walk.
constexpr double kPictureRounding = 2e-5;

}  // namespace

TEST_CASE("Light by ordinates agrees with a sweep in double precision", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras())
    for (const double theta : {0.0, 0.6, 1.2})
      for (const double scale : {0.0, 1.4}) {
        if (scale > 0 && theta != 1.2) continue;
        ResolvedScene scene = ordinatesScene(TransferFunction({{0, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.3, 0.8, 0.6}, 1.5}}}),
                                             camera, 0.8, theta, 10);
        scene.sampling.quadrature = Quadrature::midpoint;
        scene.occlusion.ordinates.scale = scale;
        const FieldBricks volume = fieldFor(scene, blobs, kBlock);
        const Picture picture = renderPicture(*context, volume, scene, kLayers);
        CHECK(picture.stats.windowTexel == Approx(scale > 0 ? 1 / scale : 1).epsilon(0.2));
        const auto exact = sweepOrdinates(volume, scene, picture.stats.windowTexel, 80);
        double colour = 0, alpha = 0, visibility = 0, shadow = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
          for (std::size_t c = 0; c < 3; ++c)
            colour = std::max(colour, std::abs(picture.colour.pixels[4 * i + c] - exact[i][c]));
          alpha = std::max(alpha, std::abs(picture.colour.pixels[4 * i + 3] - exact[i][3]));
          visibility = std::max(visibility, std::abs(picture.visibility.pixels[i] - exact[i][4]));
          shadow = std::max(shadow, exact[i][3] - exact[i][4]);
        }
        INFO("perspective " << (camera.projection == Projection::perspective) << ", theta " << theta << ", scale "
                            << scale << ": errors " << colour << ' ' << alpha << ' ' << visibility);
        CHECK(alpha < 1e-5);
        CHECK(visibility < kPictureRounding);
        // sigma_s is a parabola of the value, but linear between the 256 nodes of the table, see occlusion_gl_test.
        CHECK(colour < kPictureRounding + 3e-5);
        CHECK(shadow > 0.3);  // there is something to compare
      }
}

// A slab is integrated: a homogeneous layer of thickness L under one direction scatters
//   d_e / (d_e + d_k) (1 - exp(-sigma_t L (d_e + d_k)))     d_e, d_k: lengths per depth of the eye's and the light's
//   path
// into each pixel, however it is cut into slabs. The layer lies behind two clip planes or, with the eye inside, begins
// at the eye.
TEST_CASE("A homogeneous layer under one direction has its closed form at any slice distance", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.11;
  for (const bool perspective : {false, true})
    for (const bool inside : {false, true})
      for (const glm::dvec3& towards : {glm::dvec3(0, 0, 1), glm::dvec3(0.5, -0.3, 0.7)})
        for (const double d : {0.3, 1.0, 4.0}) {
          const double first = inside ? 0 : 20.3, last = inside ? 15.9 : 36.2;
          const double z = inside ? 40.2 : 63;
          ResolvedScene scene =
              ordinatesScene(tintedRamp({1, 0.5, 0.25}, sigma_t), straightCamera(perspective, z, 24), d, 0, 1);
          setLights(scene, {lightFrom(towards)});
          // The volume is so wide that light from aside comes through all of the layer.
          scene.clipPlanes = {{0, 0, 1, last - z}};
          if (!inside) scene.clipPlanes.push_back({0, 0, -1, z - first});
          const FieldBricks volume = fieldFor(
              scene, [](const glm::ivec3&) { return 1.0; }, kWide);
          const Picture picture = renderPicture(*context, volume, scene, kLayers);
          const double light = 1 / glm::normalize(towards).z;
          double worst = 0;
          for (int y = 0; y < scene.camera.height; ++y)
            for (int x = 0; x < scene.camera.width; ++x) {
              const double eye = viewRay(scene.camera, x + 0.5, y + 0.5).stretch();
              const double expected = eye / (eye + light) * -std::expm1(-sigma_t * (last - first) * (eye + light));
              worst = std::max({worst, std::abs(picture.visibility.at(x, y)[0] - expected),
                                std::abs(picture.colour.at(x, y)[1] - 0.5 * expected)});
            }
          INFO("perspective " << perspective << ", inside " << inside << ", towards " << towards.x << ", spacing "
                              << d);
          // Blending and carrying take a few roundings per slab; planes are placed to 1e-6 of a slab.
          const double slabs = (last - first) / d + 1;
          CHECK(worst < slabs * 10 * kFloatRounding + 4e-6 * sigma_t * d);
        }
}

// Light falls from slab to slab as each direction's own path says. What a slab's own medium leaves is computed with the
// mean length of paths that follows from share / weighted (see window_step.comp).
TEST_CASE("In a medium wider than the image each direction falls along its own path", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.11, d = 0.9, first = 20.3, last = 33.2;
  for (const bool perspective : {false, true})
    for (const double theta : {0.8, 1.2})
      for (const int bits : {32, 16}) {
        INFO("perspective " << perspective << ", theta " << theta << ", bits " << bits);
        ResolvedScene scene =
            ordinatesScene(tintedRamp({1, 0.5, 0.25}, sigma_t), straightCamera(perspective, 63, 24), d, theta, 12);
        scene.occlusion.bits = bits;
        scene.clipPlanes = {{0, 0, -1, 63 - first}, {0, 0, 1, last - 63}};
        const FieldBricks volume = fieldFor(
            scene, [](const glm::ivec3&) { return 1.0; }, kWide);
        const Picture picture = renderPicture(*context, volume, scene, kLayers);
        double worst = 0;
        for (int y = 0; y < scene.camera.height; ++y)
          for (int x = 0; x < scene.camera.width; ++x) {
            const double eye = viewRay(scene.camera, x + 0.5, y + 0.5).stretch();
            double through = 1, visibility = 0, rounding = 1e-6, before = 0;
            int slabs = 0;
            for (int i = 0; i * d < last; ++i) {
              const double kept = std::min((i + 1) * d, last) - std::max(i * d, first);
              if (kept <= 0) continue;
              double share = 0, weighted = 0;
              for (const auto& [direction, radiance] : lightDirections(scene, 12)) {
                const double stretch = 1 / direction.z;  // the camera looks down
                const double light = radiance.r * std::exp(-sigma_t * before * stretch);
                share += light;
                weighted += light / (1 + stretch);
              }
              const double tau = sigma_t * kept * eye, both = tau * (1 + (share / weighted - 1) / eye);
              visibility += through * tau * share * -std::expm1(-both) / both;
              // 16 bits round each window to half of 1/65535 per slab, perhaps always in the same direction.
              rounding += through * tau * ((bits == 16 ? slabs * 0.5 / 65535 : 0) + 20 * kFloatRounding);
              through *= std::exp(-tau);
              before += kept;
              ++slabs;
            }
            worst = std::max(worst, std::abs(picture.visibility.at(x, y)[0] - visibility) / rounding);
          }
        CHECK(worst < 1);
      }
}

TEST_CASE("Two slabs under one direction are lit as the closed form of each says", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const TwoSlabs slabs;
  const ScalarGrid grid =
      fieldGrid({glm::ivec3(-8, -8, 0), glm::ivec3(40, 40, 24)}, [](const glm::dvec3& p) { return p.z; });
  for (const glm::dvec3& towards : {glm::dvec3(0, 0, 1), glm::dvec3(-0.6, 0.2, 0.9)})
    for (const double d : {0.3, 1.0}) {
      ResolvedScene scene = ordinatesScene(slabs.transfer, straightCamera(false, 60, 16), d, 0, 1);
      scene.camera.viewHeight = 8;
      setLights(scene, {lightFrom(towards)});
      const Picture picture = renderGrid(*context, grid, scene);
      const double light = 1 / glm::normalize(towards).z, tauA = 0.4 * 3.3, tauB = 0.15 * 4.35;
      const auto scattered = [&](double tau) { return -std::expm1(-tau * (1 + light)) / (1 + light); };
      const double bins = 24.0 / 1023 * 4 * 0.4 * (1 + light);  // four edges, each displaced by a bin at most
      // A slab with an edge of a medium in it counts as one slab of the mean: at each edge it is off by up to an eighth
      // of its squared optical depth, of light and eye together.
      const double edges = 2 * (0.4 * 0.4 + 0.15 * 0.15) * d * d * (1 + light) * (1 + light) / 8;
      for (int c = 0; c < 3; ++c) {
        const double expected =
            slabs.b[c] * scattered(tauB) + std::exp(-tauB * (1 + light)) * slabs.a[c] * scattered(tauA);
        INFO("towards " << towards.x << ", spacing " << d << ", channel " << c << ": " << picture.colour.at(7, 7)[c]
                        << " for " << expected);
        for (const int pixel : {0, 7, 15})
          CHECK(std::abs(picture.colour.at(pixel, pixel)[c] - expected) < bins + edges);
      }
    }
}

// All of the light that reaches the plate in the image comes through a plate beside the image.
TEST_CASE("What is off the screen casts its shadow", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  // Slabs end on planes of voxels, so that ramps between them are integrated exactly.
  const auto field = [](const glm::ivec3& i) {
    if (i.z >= 40 && i.z < 43 && i.x >= 26 && i.x < 58 && i.y > 0 && i.y < 32) return 1.0;
    return i.z >= 18 && i.z < 20 ? 1.0 : 0.0;
  };
  const double sigma_t = 0.4;
  const glm::dvec3 towards(1, 0.1, 1);  // at the plate's height, light is some 22 units farther to the right
  for (const bool perspective : {false, true}) {
    ResolvedScene scene =
        ordinatesScene(tintedRamp(glm::dvec3(1), sigma_t), straightCamera(perspective, 64, 24), 0.5, 0, 1);
    scene.camera.viewHeight = 16;
    scene.camera.fov = 0.3;
    scene.occlusion.ordinates.directions = 1;
    setLights(scene, {lightFrom(towards)});
    const FieldBricks volume = fieldFor(scene, field, {glm::ivec3(-16, -16, 0), glm::ivec3(63, 47, 63)});
    const Picture shadowed = renderPicture(*context, volume, scene, kLayers);
    scene.clipPlanes = {{0, 0, -1, 30}};
    const Picture open = renderPicture(*context, volume, scene, kLayers);
    CHECK(maxDifference(shadowed.colour, open.colour) > 0.25);
    const double through = std::exp(-3 * sigma_t * glm::length(towards));
    double worst = 0, alpha = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        alpha = std::max(alpha, std::abs(static_cast<double>(shadowed.colour.at(x, y)[3]) - open.colour.at(x, y)[3]));
        worst = std::max(worst, std::abs(shadowed.visibility.at(x, y)[0] - through * open.visibility.at(x, y)[0]));
      }
    INFO("perspective " << perspective);
    CHECK(alpha == 0);  // the plate itself is not seen
    CHECK(worst < 1e-5);
  }
}

// The light is what shareBeyond says; see closed_forms_gl_test for the scene and for what dos makes of it.
TEST_CASE("Below an opaque half-plane ordinates have the light of the cone", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto field = [](const glm::ivec3& i) { return i.z == 24 && i.x >= 1 ? 1.0 : i.z == 4 ? -1.0 : 0.0; };
  const TransferFunction transfer(
      {{-1, {glm::dvec3(1), 1e-3}}, {0, {glm::dvec3(1), 0}}, {0.9, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), 1e4}}});
  const double theta = 60 * std::numbers::pi / 180;
  ResolvedScene scene = ordinatesScene(transfer, orthographicCamera({0, 0, 40.25}, {0, 0, 0}, 40, 80), 0.5, theta, 160);
  scene.camera.height = 1;
  scene.camera.viewHeight = 0.5;
  scene.camera.up = {0, 1, 0};
  scene.sampling.quadrature = Quadrature::midpoint;
  const FieldBricks volume = fieldFor(scene, field, {glm::ivec3(-64), glm::ivec3(63)});
  const Picture picture = renderPicture(*context, volume, scene, kLayers);
  double squares = 0, worst = 0;
  int pixels = 0;
  for (int x = 4; x < 41; ++x, ++pixels) {
    const double a = 1 - ((x + 0.5) * 0.5 - 20);
    const double seen = *picture.visibility.at(x, 0) / picture.colour.at(x, 0)[3];
    const double difference = seen - (1 - shareBeyond(theta, std::atan(a / 20)));
    squares += difference * difference;
    worst = std::max(worst, std::abs(difference));
  }
  INFO("rms " << std::sqrt(squares / pixels) << ", worst " << worst);
  // The edge of the roof is known to half a texel, 20 units away from the floor, and the share changes by up to 0.04
  // per unit there. 160 directions, of which some 13 lie side by side along the edge, count a share to 1/26 of the part
  // of the cone that they stand for, which is a tenth, or to less where rows are staggered.
  CHECK(worst < 0.02 + 0.004);
  CHECK(std::sqrt(squares / pixels) < 0.01);
}

TEST_CASE("Clipping an occluder away lights what is behind it, by ordinates as well", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const auto field = [](const glm::ivec3& i) {
    return i.z >= 22 && i.z <= 26 && i.x <= 16 ? 1.0 : i.z >= 4 && i.z <= 8 ? 1.0 : 0.0;
  };
  const auto floor = [](const glm::ivec3& i) { return i.z >= 4 && i.z <= 8 ? 1.0 : 0.0; };
  for (const bool perspective : {false, true}) {
    ResolvedScene scene = sixteenDirections(tintedRamp(glm::dvec3(1), 2), straightCamera(perspective, 50, 32), 0.5);
    const Picture roofed = renderPicture(*context, fieldFor(scene, field, kBlock), scene, kLayers);
    const Picture alone = renderPicture(*context, fieldFor(scene, floor, kBlock), scene, kLayers);
    CHECK(maxDifference(roofed.visibility, alone.visibility) > 0.15);
    scene.clipPlanes = {{0.02, -0.03, -1, 18}};
    const Picture open = renderPicture(*context, fieldFor(scene, field, kBlock), scene, kLayers);
    CHECK(layersDifference(open, alone) < kPictureRounding);  // no trace of the roof
    scene.clipPlanes.clear();
    scene.camera.nearDistance = 50 - 18;
    CHECK(layersDifference(renderPicture(*context, fieldFor(scene, field, kBlock), scene, kLayers), alone) <
          kPictureRounding);
  }
}

// Slices only multiply what is on the lattice, which does not depend on the bricks, so that only the roundings of
// texture coordinates differ. The volume has a wide gap that culling leaves out, also of the slices.
TEST_CASE("Bricks, culling, pools and textures change nothing of light by ordinates", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto far = [](const glm::ivec3& i) { return std::max(blobs(i), blobs(i + glm::ivec3(60, -11, 70))); };
  const IndexBox voxels{glm::ivec3(-60, 0, -70), glm::ivec3(31, 43, 31)};
  const glm::dvec3 middle(-14, 20, -18);
  for (Camera camera :
       {orthographicCamera({30, 5, 95}, middle, 70, 40), perspectiveCamera({20, 8, 75}, middle, 1, 40)}) {
    INFO("perspective " << (camera.projection == Projection::perspective));
    ResolvedScene scene = ordinatesScene(tintedRamp({0.9, 0.5, 0.2}, 1.2), camera, 0.8, 1.2, 12);
    scene.bricks.culling = false;
    scene.bricks.interior = 128;
    const Picture whole = renderPicture(*context, fieldFor(scene, far, voxels), scene, kLayers);
    double shadow = 0;
    for (std::size_t i = 0; i < whole.visibility.pixels.size(); ++i)
      shadow = std::max(shadow, double(whole.colour.pixels[4 * i + 3]) - whole.visibility.pixels[i]);
    REQUIRE(shadow > 0.3);
    scene.bricks.culling = true;
    for (const int interior : {8, 16}) {
      INFO("bricks of " << interior);
      scene.bricks.interior = interior;
      const FieldBricks volume = fieldFor(scene, far, voxels);
      const Picture bricked = renderPicture(*context, volume, scene, kLayers);
      CHECK(bricked.stats.visibleBricks < 90u * 16 * 16 * 16 / (interior * interior * interior));
      CHECK(layersDifference(bricked, whole) < kPictureRounding);
      RenderOptions options = kLayers;
      options.reverseBricks = true;
      const Picture reversed = renderPicture(*context, volume, scene, options);
      CHECK(layersDifference(reversed, bricked) == 0);
      AtlasLimits limits;
      limits.maxTextureBytes = bricked.stats.textureBytes / 3;
      const Picture textures = renderPicture(*context, volume, scene, kLayers, limits);
      CHECK(textures.stats.textures > 2);
      CHECK(layersDifference(textures, whole) < kPictureRounding);
      limits = {};
      limits.maxTextureEdge = 2 * volume.layout.edge().x;
      const Picture small = renderPicture(*context, volume, scene, kLayers, limits);
      CHECK(small.stats.textures > 2);
      CHECK(layersDifference(small, whole) < kPictureRounding);
      limits = {};
      limits.budgetBytes = bricked.stats.textureBytes * 2 / 3;
      const Picture pooled = renderPicture(*context, volume, scene, kLayers, limits);
      CHECK(pooled.stats.textureBytes < bricked.stats.textureBytes);
      CHECK(layersDifference(pooled, whole) < kPictureRounding);
    }
  }
}

// The same picture is made on its own and after another one, also from a camera that needs larger windows.
TEST_CASE("A picture by ordinates does not depend on the ones before", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = ordinatesScene(tintedRamp({0.9, 0.5, 0.2}, 1.2), blobCameras()[0], 0.8, 1.2, 20);
  FieldOptions options;
  options.interior = scene.bricks.interior;
  options.apron = 2;  // enough for the widest of the views
  const FieldBricks volume(blobs, kBlock, options);
  const Picture alone = renderPicture(*context, volume, scene, kLayers);
  SliceRenderer renderer(*context, volume, scene, kLayers);
  for (const Camera& between :
       {blobCameras()[1], perspectiveCamera({16, 16, 16}, {40, 9, 3}, 1.8, 40),
        orthographicCamera({-50, 3, 9}, {16, 16, 16}, 200, 40), orthographicCamera({-50, 3, 9}, {-60, 3, 9}, 20, 40)}) {
    renderer.render(between);
    const Picture again = renderer.render(scene.camera);
    CHECK(layersDifference(again, alone) == 0);
    CHECK(again.depth.pixels == alone.depth.pixels);
  }
}

// A set of directions that is listed several times is the same light, but needs more than one group of directions.
TEST_CASE("Many directions are lit in groups, which add up to what one group has", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras())
    for (const bool coloured : {false, true}) {
      ResolvedScene scene = ordinatesScene(tintedRamp({0.9, 0.5, 0.2}, 1.2), camera, 0.8, 1.1, 15);
      std::vector<ListedDirection> once, often;
      for (const auto& [direction, radiance] : lightDirections(scene, 15)) {
        const glm::dvec3 colour = coloured ? 0.5 + 0.5 * direction : glm::dvec3(1);
        once.push_back({direction, radiance.r, colour});
      }
      for (int copy = 0; copy < 10; ++copy)
        for (const ListedDirection& listed : once)
          often.push_back({listed.direction, 0.1 * listed.weight, listed.colour});
      REQUIRE(often.size() > 128);
      const FieldBricks volume = fieldFor(scene, blobs, kBlock);
      const Picture cone = renderPicture(*context, volume, scene, kLayers);
      CHECK(cone.stats.directions == static_cast<int>(once.size()));
      setLights(scene, {lightFrom(once, LightFrame::world)});
      const Picture one = renderPicture(*context, volume, scene, kLayers);
      setLights(scene, {lightFrom(often, LightFrame::world)});
      const Picture groups = renderPicture(*context, volume, scene, kLayers);
      INFO("coloured " << coloured << ", perspective " << (camera.projection == Projection::perspective));
      CHECK(groups.stats.directions == static_cast<int>(often.size()));
      // These are sums of 150 numbers instead of 15.
      CHECK(layersDifference(groups, one) < 150 * kFloatRounding);
      if (!coloured) CHECK(layersDifference(one, cone) < 15 * kFloatRounding);
    }
}

// Where paths through a slab have equal lengths, the slab keeps the same of each, alone or together. Otherwise this is
// computed with the mean of the lengths, whose error falls as slabs get thinner.
TEST_CASE("Pictures of lights add up to the picture of all of them", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::dvec3 red(1, 0.2, 0.1), blue(0.1, 0.3, 0.8);
  for (const Camera& camera : blobCameras())
    for (const bool equalPaths : {true, false}) {
      const glm::dvec3 left(-0.6, 0.1, 0.7), right = equalPaths ? glm::dvec3(0.6, 0.1, 0.7) : glm::dvec3(0.1, 0.2, 0.9);
      std::vector<double> differences;
      for (const double d : {0.8, 0.4}) {
        ResolvedScene scene = sixteenDirections(tintedRamp({0.9, 0.8, 0.7}, 1.2), camera, d);
        const FieldBricks volume = fieldFor(scene, blobs, kBlock);
        setLights(scene, {lightFrom(left, red)});
        Image sum = renderPicture(*context, volume, scene).colour;
        setLights(scene, {lightFrom(right, blue)});
        const Image other = renderPicture(*context, volume, scene).colour;
        setLights(scene, {lightFrom(left, red), lightFrom(right, blue)});
        const Image both = renderPicture(*context, volume, scene).colour;
        for (std::size_t i = 0; i < sum.pixels.size(); ++i)
          if (i % 4 != 3) sum.pixels[i] += other.pixels[i];
        differences.push_back(maxDifference(sum, both));
      }
      INFO("equal paths " << equalPaths << ": " << differences[0] << ' ' << differences[1]);
      if (equalPaths) CHECK(std::max(differences[0], differences[1]) < 80 * 4 * kFloatRounding);
      CHECK(differences[0] < 0.015);  // where slabs have an optical depth of 0.8
      if (!equalPaths) CHECK(differences[1] < 0.65 * differences[0]);
    }
}

// A window is rounded to half of 1/65535 each time that a slice multiplies it, so that after N slices it is off by N
// times that at most: this is less than SamplingOptions::bits promises.
TEST_CASE("Windows of 16 bits stay within half a step per slice", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras())
    for (const double d : {0.8, 0.1}) {
      ResolvedScene scene = ordinatesScene(tintedRamp({0.9, 0.5, 0.2}, 0.6), camera, d, 1, 12);
      const FieldBricks volume = fieldFor(scene, blobs, kBlock);
      const Picture fine = renderPicture(*context, volume, scene, kLayers);
      scene.occlusion.bits = 16;
      const Picture coarse = renderPicture(*context, volume, scene, kLayers);
      CHECK(coarse.stats.windowBytes < fine.stats.windowBytes);
      const double difference = layersDifference(coarse, fine);
      INFO("slices " << fine.stats.slices << ", difference " << difference);
      CHECK(difference > 0);
      CHECK(difference < 0.5 / 65535 * static_cast<double>(fine.stats.slices) + 1e-5);
    }
}

TEST_CASE("Without an aperture any number of directions is one, straight towards the viewer", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras()) {
    ResolvedScene scene = ordinatesScene(tintedRamp({0.9, 0.5, 0.2}, 1.2), camera, 0.8, 0, 16);
    const FieldBricks volume = fieldFor(scene, blobs, kBlock);
    const Picture straight = renderPicture(*context, volume, scene, kLayers);
    CHECK(straight.stats.directions == 1);
    scene.occlusion.ordinates.directions = 1;
    scene.occlusion.aperture = 1.2;
    CHECK(layersDifference(renderPicture(*context, volume, scene, kLayers), straight) == 0);
    setLights(scene, {lightFrom({0, 0, 3})});
    CHECK(layersDifference(renderPicture(*context, volume, scene, kLayers), straight) == 0);
  }
}
