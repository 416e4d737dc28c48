// Pictures lit by light volumes: against the reference, and what must not change them.
// SPDX-License-Identifier: Apache-2.0
#include <complex>

#include "shade/hard_case.h"
#include "shade/progressive_slices.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

ResolvedScene lightVolumeScene(const TransferFunction& transfer, const Camera& camera, double spacing = 2.5,
                               int directions = 12) {
  ResolvedScene scene = plainScene(transfer, camera, spacing);
  scene.model = Model::cone;
  scene.method = Method::lightVolume;
  scene.occlusion.aperture = 60 * kDegree;
  scene.occlusion.ordinates.directions = directions;
  scene.sampling.segments = segmentsOf(spacing);
  return scene;
}

// Returns the picture of the reference for the very directions of the scene.
Image exactColour(const ScalarGrid& grid, const ResolvedScene& scene) {
  ReferenceOptions options;
  options.lights = lightDirections(scene, scene.occlusion.ordinates.directions);
  options.tolerance = 2e-4;
  return renderReference(grid, scene, options).colour;
}

// A slab whose upper face is a slanting plane through voxels, of 200 units inside.
ScalarGrid slantingSolid(int edge) {
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.25, 0.18, 1)), middle(0.5 * (edge - 1));
  return makeFilled(glm::ivec3(edge), {0, 0, 0}, [=](const glm::ivec3& i) {
    return 200 * std::clamp(0.5 - glm::dot(up, glm::dvec3(i) - middle), 0.0, 1.0);
  });
}
TransferFunction solid(double sigma_t) { return TransferFunction({{60, {kAlbedo, 0}}, {140, {kAlbedo, sigma_t}}}); }

LightSource worldCone(const glm::dvec3& axis) {
  return {LightFrame::world, ConeLight{axis, 0.4, glm::dvec3(1, 0.8, 0.5)}};
}

}  // namespace

TEST_CASE("A light volume gives the picture of the reference", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  // What is left is the interpolation of light between voxels, which is of second order in their optical depth.
  for (const auto& [sigma_t, most] : {std::pair{0.3, 2e-3}, {1.0, 6e-3}})
    for (const Camera& camera : smallCameras(40))
      for (const double spacing : {0.7, 2.5}) {
        const ResolvedScene scene = lightVolumeScene(ramp(sigma_t), camera, spacing);
        INFO("sigma_t " << sigma_t << ", perspective " << (camera.projection == Projection::perspective) << ", spacing "
                        << spacing);
        CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exactColour(grid, scene)) < most);
      }
}

TEST_CASE("Light begins at the plane that cuts a solid", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(24), {0, 0, 0}, [](const glm::ivec3&) { return 1.0; });
  for (const Camera& camera : smallCameras(40))
    for (const double offset : {0.0, 0.37, 0.71}) {
      ResolvedScene scene = lightVolumeScene(ramp(0.5), camera);
      const glm::dvec3 inside = glm::normalize(glm::dvec3(-0.5, -0.2, -0.9));
      scene.clipPlanes.emplace_back(inside, -glm::dot(inside, kSmallCentre) + offset);
      scene.clipPlanes.emplace_back(0, 1, 0, -6.4);
      INFO("perspective " << (camera.projection == Projection::perspective) << ", cut " << offset);
      const Image exact = exactColour(grid, scene);
      CHECK(largestAlpha(exact) > 0.9);
      // Light that falls as exp(-x) is too bright by up to x^2 / 8 between two voxels, and x is 0.5 to 1 here. Were
      // light to begin half a voxel off the cut, the error would be 0.1.
      CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exact) < 0.018);
    }
}

TEST_CASE("A visible background is lit from the box where it ends", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  const TransferFunction transfer({{0, {kAlbedo, 0.15}}, {1, {kAlbedo, 0.6}}});
  for (const Camera& camera : smallCameras(32)) {
    const ResolvedScene scene = lightVolumeScene(transfer, camera);
    CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exactColour(grid, scene)) < 8e-3);
  }
}

TEST_CASE("A peak of the function that no voxel has occludes", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  // Whole numbers with nothing at any of them, over another medium that receives the shadow.
  const ScalarGrid grid = makeFilled(glm::ivec3(24), {0, 0, 0}, [](const glm::ivec3& i) {
    return i.z >= 16 ? 0.0 : i.z >= 12 ? 1.0 : 4.0;
  });
  const TransferFunction transfer(
      {{0.2, {kAlbedo, 0}}, {0.5, {kAlbedo, 2.0}}, {0.8, {kAlbedo, 0}}, {3, {kAlbedo, 0}}, {4, {kAlbedo, 0.4}}});
  const ResolvedScene scene = lightVolumeScene(transfer, smallCameras(32).front(), 1.25);
  const Image exact = exactColour(grid, scene);
  CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exact) < 0.035);
  // Were the peak missed on the way of light, the medium below would be lit as it is without the peak.
  ResolvedScene bare = scene;
  bare.transfer = TransferFunction({{3, {kAlbedo, 0}}, {4, {kAlbedo, 0.4}}});
  CHECK(rmsDifference(exactColour(grid, bare), exact) > 0.1);
}

TEST_CASE("Bricks and memory change no picture of a light volume", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  // One half is solid, so that many bricks have one value and could share a slot.
  const ScalarGrid grid = makeFilled(glm::ivec3(40), {0, 0, 0}, [](const glm::ivec3& i) {
    return i.z < 20 ? 1.0 : 0.7 * coneAt(i, {{20, 20, 30, 9}});
  });
  ResolvedScene scene = lightVolumeScene(ramp(0.4), perspectiveCamera({70, 50, 90}, {20, 20, 20}, 0.6, 48));
  scene.bricks.interior = 40;
  const Picture whole = renderGrid(*context, grid, scene, kLayers);
  for (const int interior : {8, 16}) {
    scene.bricks.interior = interior;
    const auto bricks = bricksFor(grid, scene);
    const Picture bricked = renderPicture(*context, *bricks, scene, kLayers);
    CHECK(maxDifference(whole.colour, bricked.colour) < 1e-4);
    CHECK(maxDifference(whole.visibility, bricked.visibility) < 1e-4);
    // So many that one slice fits; the light of a brick travels with it.
    AtlasLimits limits;
    limits.budgetBytes = bricks->layout.voxels() * 2 * (interior == 8 ? 190 : 50);
    const Picture streamed = renderPicture(*context, *bricks, scene, kLayers, limits);
    CHECK(streamed.stats.brickSlots * bricks->layout.voxels() * 2 > limits.budgetBytes);
    // A driver may find texels elsewhere in a smaller texture by a little.
    CHECK(maxDifference(streamed.colour, bricked.colour) < 1e-4);
  }
}

TEST_CASE("Renderers of several methods share a volume with bricks of one value", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid =
      makeFilled(glm::ivec3(40), {0, 0, 0}, [](const glm::ivec3& i) { return i.z < 36 ? 1.0 : 0.0; });
  ResolvedScene lit = lightVolumeScene(ramp(0.4), perspectiveCamera({70, 50, 90}, {20, 20, 20}, 0.6, 32));
  lit.bricks.interior = 8;
  ResolvedScene plain = lit;
  plain.model = Model::emission;
  const auto bricks = bricksFor(grid, lit);
  const Image litAlone = renderPicture(*context, *bricks, lit).colour;
  const Image plainAlone = renderPicture(*context, *bricks, plain).colour;
  ResidentVolume resident(*context, *bricks, atlasOptions(lit, *bricks));
  SliceRenderer first(resident, plain), second(resident, lit);
  // A driver may find texels elsewhere in a smaller texture by a little.
  for (int i = 0; i < 2; ++i) {
    CHECK(maxDifference(first.render().colour, plainAlone) < 2e-4);
    CHECK(maxDifference(second.render().colour, litAlone) < 2e-4);
  }
  first.setLight(Model::cone, Method::lightVolume, {});
  CHECK(maxDifference(first.render().colour, litAlone) < 2e-4);
}

TEST_CASE("Light of the world is not swept again as the camera moves", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = lightVolumeScene(ramp(0.5), smallCameras().front());
  scene.model = Model::lights;
  scene.lights = {worldCone({0.3, 0.2, 1})};
  const auto bricks = bricksFor(grid, scene);
  SliceRenderer renderer(*context, *bricks, scene);
  const auto swept = [&] { return renderer.render().stats.lightMs > 0; };
  CHECK(swept());
  CHECK_FALSE(swept());
  renderer.setCamera(orthographicCamera({25, 28, 40}, kSmallCentre, 30, 32));
  CHECK_FALSE(swept());
  CHECK(maxDifference(renderer.render().colour, renderGrid(*context, grid, renderer.scene()).colour) == 0);
  renderer.setTransfer(ramp(0.7));
  CHECK(swept());
  renderer.setClip({ClipPlane(0, 0, -1, 15)}, {});
  CHECK(swept());
  renderer.setLight(Model::lights, Method::lightVolume, {worldCone({0.2, 0.3, 1})});
  CHECK(swept());
  CHECK_FALSE(swept());
  // The cone around the view axis moves with the camera.
  renderer.setLight(Model::cone, Method::lightVolume, {});
  CHECK(swept());
  CHECK_FALSE(swept());
  renderer.setCamera(orthographicCamera({30, 22, 40}, kSmallCentre, 30, 32));
  CHECK(swept());
  OcclusionOptions narrow = renderer.scene().occlusion;
  narrow.aperture = 0.5;
  renderer.setOcclusion(narrow);
  CHECK(swept());
  CHECK(maxDifference(renderer.render().colour, renderGrid(*context, grid, renderer.scene()).colour) == 0);
}

TEST_CASE("Coloured lights of a light volume are those of the reference", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = lightVolumeScene(ramp(0.5), smallCameras(40).back());
  scene.model = Model::lights;
  scene.lights = {worldCone({0.4, 0.2, 1}),
                  {LightFrame::view, ConeLight{{-0.6, 0, 1}, 0.3, glm::dvec3(0.1, 0.3, 1.5)}}};
  const Picture picture = renderGrid(*context, grid, scene, kLayers);
  CHECK(rmsDifference(picture.colour, exactColour(grid, scene)) < 4e-3);
  ReferenceOptions options;
  options.lights = lightDirections(scene, scene.occlusion.ordinates.directions);
  CHECK(rmsDifference(picture.visibility, renderReference(grid, scene, options).visibility) < 6e-3);
}

// Rings of `ordinates` on slanting surfaces come at the distance of slices; a light volume has none.
TEST_CASE("No ripple on a slanting solid has the period of slices", "[shade][light-volume][slow][gl]") {
  const auto context = testContext();
  if (!context) return;
  constexpr int kEdge = 64, kPixels = 128;
  const ScalarGrid grid = slantingSolid(kEdge);
  const glm::dvec3 centre(0.5 * (kEdge - 1));
  Camera camera = orthographicCamera(centre + glm::dvec3(40, -35, 90), centre, 30, kPixels);
  ResolvedScene scene = lightVolumeScene(solid(0.8), camera, 2.5, 16);
  // Across the picture depth changes steadily, so that slices come at one frequency.
  const auto amplitude = [&](const Image& image, const Image& exact) {
    const CameraFrame axes = cameraFrame(camera);
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.25, 0.18, 1));
    const double pixel = screenPlane(camera).pixelSize.x;
    // Along a row the surface's depth changes by this for a pixel: the plane is dot(up, x) = const.
    const double depth = -pixel * glm::dot(up, axes.right) / glm::dot(up, axes.forward);
    const double frequency = std::abs(depth) / scene.sampling.spacing;  // cycles a pixel
    REQUIRE(frequency * kPixels > 2);  // so that the window of the transform tells it from a constant
    double worst = 0;
    for (int y = kPixels / 4; y < 3 * kPixels / 4; y += 8) {
      std::complex<double> sum = 0;
      double weights = 0;
      for (int x = 0; x < kPixels; ++x) {
        const auto at = static_cast<std::size_t>(4 * (y * kPixels + x));
        const double window = std::pow(std::sin(std::numbers::pi * (x + 0.5) / kPixels), 2);
        const double error = image.pixels[at] - exact.pixels[at];
        sum += window * error * std::polar(1.0, -2 * std::numbers::pi * frequency * x);
        weights += window;
      }
      worst = std::max(worst, 2 * std::abs(sum) / weights);
    }
    return worst;
  };
  const Image exact = exactColour(grid, scene);
  const double volume = amplitude(renderGrid(*context, grid, scene).colour, exact);
  scene.method = Method::ordinates;
  const double windows = amplitude(renderGrid(*context, grid, scene).colour, exact);
  INFO("amplitude at the period of slices: light volume " << volume << ", ordinates " << windows);
  CHECK(windows > 4e-3);
  CHECK(volume < 0.25 * windows);
}

TEST_CASE("Samples of a light volume average to finer light", "[shade][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = lightVolumeScene(ramp(0.8), smallCameras(32).back(), 1.25, 6);
  ReferenceOptions fine;
  fine.directions = 256;
  const Image exact = renderReference(grid, scene, fine).colour;
  const auto bricks = brickGrid(grid, {16, requiredApron(coarserScene(scene), grid.indexToWorld()), false});
  ProgressiveOptions options;
  options.passes = 8;
  options.pixelArea = false;  // the pictures beside it are through the centres of pixels
  const ProgressivePicture mean = progressiveSlices(*context, *bricks, scene, options);
  CHECK(mean.passes == 8);
  CHECK(std::isfinite(mean.error.total()));
  CHECK(rmsDifference(mean.picture.colour, exact) <
        0.85 * rmsDifference(renderGrid(*context, grid, scene).colour, exact));
  // A target above what light at voxels leaves is reached.
  options.passes = 32;
  options.targetError = 1.2 * mean.error.total();
  CHECK(progressiveSlices(*context, *bricks, scene, options).reachedTarget);
}
