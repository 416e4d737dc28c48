// Pictures by rays on OpenGL: closed forms, the slices that they share segments with, the reference, and what must not
// change them.
// SPDX-License-Identifier: Apache-2.0
#include "shade/hard_case.h"
#include "support/closed_forms.h"
#include "support/random_transfer.h"
#include "umbrick/core/error.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;

namespace {

Picture cast(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
             const RenderOptions& options = {}, const AtlasLimits& limits = {}, const RenderSample& sample = {}) {
  const auto bricks = bricksFor(grid, scene);
  return RayCaster(context, *bricks, scene, options, limits).render(sample);
}

// Renders with segments of the scene's length and of half of it, and compares with the reference, as
// checkAgainstReference does for slices.
void checkRays(const GlContext& context, const ScalarGrid& grid, ResolvedScene scene, double floor = 2e-5,
               double mostChange = 8e-3) {
  const Image exact = renderReference(grid, scene).colour;
  const Image coarse = cast(context, grid, scene).colour;
  scene.sampling.segments *= 2;
  const Image fine = cast(context, grid, scene).colour;
  const double change = rmsDifference(coarse, fine), rest = rmsDifference(fine, exact);
  INFO("change by half segments " << change << ", left to the reference " << rest << ", largest opacity "
                                  << largestAlpha(exact));
  CHECK(largestAlpha(exact) > 0.05);  // there is something to compare
  CHECK(change < mostChange);
  CHECK(rest < 0.6 * change + floor);
}

// Rays and slices, or rays through other bricks, integrate between the same places, whose coordinates they round
// differently: by 8 * 2^-25 of some hundred texels, 3e-5 of a voxel (see coordinateError of check). Medium comes or
// goes at the borders of a ray by as much as lies in there: with sigma_t up to 5 at four borders 6e-4 in all, and with
// the soft blobs, which have none, only sums are rounded.
constexpr double kSameSegments = 6e-4;
constexpr double kSameBlobs = 2e-5;

}  // namespace

// Opacity is that of the length of the ray in the box: exp(-tau) by its definition. Six planes cut it, so that first
// and last segments are of any length; single precision knows where they end to 1e-6 of a voxel or so.
TEST_CASE("Rays through a homogeneous box let through exp(-tau)", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(32), {-5, 3, 7}, [](const glm::ivec3&) { return 1.0; });
  const Box box{{-1.3, 6.2, 11.7}, {20.4, 28.1, 31.9}};
  const glm::dvec3 centre = 0.5 * (box.min + box.max);
  const double sigma_t = 0.06;
  for (const Camera& camera :
       {orthographicCamera(centre + glm::dvec3(40, -20, 35), centre, 40, 24),
        orthographicCamera(centre + glm::dvec3(0, 0, 60), centre, 40, 24),
        perspectiveCamera(centre + glm::dvec3(-30, 45, 35), centre, 0.6, 24),
        perspectiveCamera(centre + glm::dvec3(2.2, -1.1, 3.3), centre + glm::dvec3(9, 5, 1), 2.2, 24)})
    for (const int segments : {1, 3}) {
      ResolvedScene scene = plainScene(ramp(sigma_t), camera, 0.8);
      scene.sampling.segments = segments;
      scene.clipBox = box;
      const Picture picture = cast(*context, grid, scene);
      const std::vector<ClipPlane> planes = boxPlanes(box);
      double worst = 0, most = 0;
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
          const double alpha = -std::expm1(-sigma_t * keptDepths(ray, planes).length() * ray.stretch());
          worst = std::max(worst, std::abs(alpha - picture.colour.at(x, y)[3]));
          for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(kAlbedo[c] * alpha - picture.colour.at(x, y)[c]));
          most = std::max(most, alpha);
        }
      INFO("perspective " << (camera.projection == Projection::perspective) << ", segments " << segments);
      CHECK(most > 0.5);
      CHECK(worst < 1e-5);
    }
}

// See the test of slices for what is allowed: the surface lies where the interpolated square of the distance says, and
// segments bend at the ramp.
TEST_CASE("A homogeneous sphere seen by rays has the opacity of its chords", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double radius = 10, sigma_t = 0.09, d = 0.25;
  const glm::dvec3 centre(12.3, 11.9, 12.1);
  const ScalarGrid grid = fieldGrid(
      {glm::ivec3(0), glm::ivec3(24)},
      [&](const glm::dvec3& p) { return radius * radius - glm::dot(p - centre, p - centre) + 0.375; }, glm::dmat4(1),
      -1000);
  const TransferFunction transfer({{-10, {kAlbedo, 0}}, {10, {kAlbedo, sigma_t}}});
  for (const Camera& camera :
       {orthographicCamera(centre + glm::dvec3(30, -20, 25), centre, 24, 24),
        perspectiveCamera(centre + glm::dvec3(-30, 25, 35), centre, 0.5, 24),
        perspectiveCamera(centre + glm::dvec3(2, -1, 3), centre + glm::dvec3(9, 5, 1), 1.4, 24)}) {
    const Picture picture = cast(*context, grid, plainScene(transfer, camera, d));
    double worst = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        const glm::dvec3 w = ray.direction / ray.stretch(), to = centre - ray.origin;
        const double along = glm::dot(to, w), across = glm::dot(to, to) - along * along;
        const auto tau = [&](double shift) {
          return integral(
              -10, 10,
              [&](double soft) {
                const double reach = std::sqrt(std::max(0.0, radius * radius + shift + soft - across));
                return sigma_t * (std::max(0.0, along + reach) - std::max(0.0, along - reach)) / 20;
              },
              200);
        };
        const double shift = 0.375 + d * d / 4 + 0.05;  // 0.05: Gauss nodes at the kink of the square root
        const double alpha = picture.colour.at(x, y)[3];
        worst = std::max({worst, -std::expm1(-tau(-shift)) - alpha, alpha + std::expm1(-tau(shift))});
      }
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("Rays make the picture of slices", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  std::mt19937 random(5);
  const ScalarGrid straight = makeDense(glm::ivec3(40, 37, 33), {-7, 3, 100}),
                   crooked = withTransform(makeDense(glm::ivec3(30), {2, -40, 5}, 3), crookedTransform());
  for (int trial = 0; trial < 8; ++trial) {
    const ScalarGrid& grid = trial % 4 < 2 ? straight : crooked;
    Camera base;
    base.width = 45;
    base.height = 40;
    base.projection = trial % 2 ? Projection::orthographic : Projection::perspective;
    // Middles of segments that lie near a step of the function, or planes that cut segments and not slabs, would make
    // pictures of other segments.
    const bool midpoint = trial % 3 == 1 && trial < 6, segments = trial % 3 == 2;
    ResolvedScene scene = plainScene(trial >= 6             ? randomTransferFunction2d(random, 4).windowed(0.2, 0.8)
                                     : midpoint || segments ? ramp(1.5, 0.2)
                                                            : randomTransferFunction(random, 8).windowed(0.1, 0.9),
                                     orbitCamera(grid.worldBounds(), 1.1 * trial, 0.3, base), 0.7);
    if (segments) scene.sampling.segments = 3;
    if (midpoint) scene.sampling.quadrature = Quadrature::midpoint;
    RenderSample sample;
    sample.phase = trial % 2 ? 0.5 : 0.31;
    sample.pixel = {0.2, 0.9};
    const auto bricks = bricksFor(grid, scene);
    const Picture slices = SliceRenderer(*context, *bricks, scene, kLayers).render(sample);
    const Picture rays = RayCaster(*context, *bricks, scene, kLayers).render(sample);
    INFO("trial " << trial);
    REQUIRE(largestAlpha(slices.colour) > 0.1);
    CHECK(maxDifference(rays.colour, slices.colour) < kSameSegments);
    CHECK(maxDifference(rays.visibility, slices.visibility) < kSameSegments);
    CHECK(maxDifference(rays.opacity, slices.opacity) < kSameSegments);
    // A slab has the depth of its middle, also where a plane cuts it; its segments have their own, and those that are
    // cut that of what is left.
    for (std::size_t i = 0; i < rays.depth.pixels.size(); ++i)
      if (slices.opacity.pixels[i] > 0.01f)
        CHECK(std::abs(rays.depth.pixels[i] - slices.depth.pixels[i]) < 0.5 * scene.sampling.spacing + 2e-2);
    CHECK(rays.stats.fragments > 0);
  }
}

TEST_CASE("Rays along each axis and through crooked grids approach the reference", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const glm::dvec3& from : {glm::dvec3(30, 6, 8), glm::dvec3(-30, 5, -9), glm::dvec3(7, -30, -8),
                                 glm::dvec3(0, 0, 30), glm::dvec3(-30, 0, 0)})
    for (const Camera& camera : {orthographicCamera(kSmallCentre + from, kSmallCentre, 30, 32),
                                 perspectiveCamera(kSmallCentre + from, kSmallCentre, 0.6, 32)}) {
      INFO("eye " << camera.eye.x << " " << camera.eye.y << " " << camera.eye.z);
      checkRays(*context, grid, plainScene(ramp(0.6), camera, 0.5));
    }
  const ScalarGrid crooked = withTransform(grid, crookedTransform());
  Camera base;
  base.width = base.height = 32;
  checkRays(*context, crooked, plainScene(ramp(0.6), orbitCamera(crooked.worldBounds(), 1.7, 0.4, base), 0.5));
}

TEST_CASE("Rays from within the volume and views of more than 90 degrees approach the reference", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const double fov : {0.5, 1.4, 2.4})
    for (const glm::dvec3& eye : {glm::dvec3(12.3, 9.1, 17.2), glm::dvec3(12, 9, 17), glm::dvec3(15.5, 15.5, 15.5)}) {
      const Camera camera = perspectiveCamera(eye, kSmallCentre + glm::dvec3(0.3, 0.5, -1), fov, 32);
      INFO("fov " << fov << ", eye " << eye.x << " " << eye.y << " " << eye.z);
      // Rays of neighbouring pixels part beside the eye, so that kinks of the field are sharp in the picture.
      checkRays(*context, grid, plainScene(ramp(0.2), camera, 0.3), 2e-4, 2e-2);
    }
}

TEST_CASE("Clip planes, clip box and near plane cut rays at their place", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras()) {
    ResolvedScene scene = plainScene(ramp(0.6), camera, 0.5);
    SECTION("planes") { scene.clipPlanes = {{0.3, -0.5, -0.8, 14}, {0, 1, 0, -5.3}}; }
    SECTION("box") { scene.clipBox = Box{{4.2, 5.1, 3}, {17.5, 16.3, 14.9}}; }
    SECTION("near plane") { scene.camera.nearDistance = 33; }
    SECTION("nothing is kept") {
      scene.clipPlanes = {{1, 0, 0, -100}};
      CHECK(largestAlpha(cast(*context, grid, scene).colour) == 0);
      continue;
    }
    checkRays(*context, grid, scene, 1e-4, 2e-2);
  }
}

TEST_CASE("A background that rays see ends where the medium does", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(
      glm::ivec3(20), {3, 4, 5}, [](const glm::ivec3& i) { return 1 + 0.05 * i.x; }, 1);
  for (const Camera& camera : smallCameras())
    checkRays(*context, grid, plainScene(TransferFunction({{0, {kAlbedo, 0}}, {2, {kAlbedo, 0.1}}}), camera, 0.5), 1e-4,
              3e-2);
}

// All are the same segments. Coordinates are rounded for one brick or another.
TEST_CASE("Bricks, culling, textures and memory change no picture of rays", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense(glm::ivec3(40, 37, 33), {-7, 3, 100});
  std::mt19937 random(9);
  for (int trial = 0; trial < 4; ++trial) {
    Camera base;
    base.width = base.height = 40;
    base.projection = trial % 2 ? Projection::orthographic : Projection::perspective;
    ResolvedScene scene = plainScene(trial == 3 ? randomTransferFunction2d(random, 4).windowed(0.2, 0.8)
                                                : randomTransferFunction(random, 8).windowed(0.1, 0.9),
                                     orbitCamera(grid.worldBounds(), 1.1 * trial, 0.3, base), 0.5);
    if (trial == 2) scene.camera.eye = scene.camera.lookAt + glm::dvec3(1, 2, 3);  // in the volume
    INFO("trial " << trial);
    BrickOptions options;
    options.apron = requiredApron(scene, grid.indexToWorld());
    options.gradients = scene.transfer.is2d();
    options.interior = 64;
    const auto one = cutGrid(grid, options, false);
    const Image whole = RayCaster(*context, *one, scene).render().colour;
    REQUIRE(largestAlpha(whole) > 0.1);
    for (const int interior : {8, 16, 24}) {
      scene.bricks.interior = interior;
      for (const bool culling : {true, false}) {
        scene.bricks.culling = culling;
        CHECK(maxDifference(cast(*context, grid, scene).colour, whole) < kSameSegments);
      }
    }
    scene.bricks.interior = 8;
    const Picture all = cast(*context, grid, scene);
    // Textures of which the shader reads up to four at once, and more than that.
    for (const int edge : {40, 20}) {
      const Picture spread = cast(*context, grid, scene, {}, {.maxTextureEdge = edge});
      CHECK(spread.stats.textures > (edge == 40 ? 1 : 4));
      CHECK(maxDifference(spread.colour, all.colour) < kSameSegments);
    }
    // Pools of a part of the bricks, down to one: runs are drawn nearest first.
    for (const int slots : {50, 7, 1}) {
      const std::uint64_t slot = all.stats.textureBytes / all.stats.brickSlots;
      const Picture streamed =
          cast(*context, grid, scene, {}, {.budgetBytes = slot * static_cast<std::uint64_t>(slots) + slot / 2});
      INFO("slots " << slots);
      CHECK(streamed.stats.uploadedBricks >= all.stats.brickSlots);
      CHECK(maxDifference(streamed.colour, all.colour) < kSameSegments);
    }
  }
}

TEST_CASE("Light volumes light rays as they light slices", "[shade][rays][light-volume][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid({3, -20, 7});
  for (Camera camera : smallCameras(40)) {
    camera.eye += glm::dvec3(3, -20, 7);
    camera.lookAt += glm::dvec3(3, -20, 7);
    ResolvedScene scene = plainScene(ramp(0.8), camera, 1.25);
    scene.method = Method::lightVolume;
    scene.sampling.segments = 2;
    scene.occlusion.ordinates.directions = 8;
    SECTION("cone") { scene.model = Model::cone; }
    SECTION("ambient") { scene.model = Model::ambient; }
    SECTION("coloured lights") {
      scene.model = Model::lights;
      scene.lights = {{LightFrame::world, ConeLight{{1, 0.2, 0.4}, 0.3, glm::dvec3(2, 1.1, 0.3)}},
                      {LightFrame::view, ConeLight{{0, 1, 0.1}, 0.5, glm::dvec3(0.1, 0.4, 1.3)}}};
    }
    scene.clipPlanes = {{0.3, -0.5, -0.8, 8.7}};  // cuts the medium, so that light begins there
    const auto bricks = bricksFor(grid, scene);
    SliceRenderer slices(*context, *bricks, scene, kLayers);
    RayCaster rays(*context, *bricks, scene, kLayers);
    const Picture expected = slices.render();
    const Picture picture = rays.render();
    REQUIRE(largestAlpha(picture.colour) > 0.3);
    CHECK(picture.stats.directions == expected.stats.directions);
    // Where the plane cuts a slab, slices cut what is left into segments, and rays cut segments: both are of second
    // order, but not the same. The reference stands between them in the test of clip planes.
    CHECK(rmsDifference(picture.colour, expected.colour) < 2e-3);
    CHECK(rmsDifference(picture.visibility, expected.visibility) < 2e-3);
    scene.clipPlanes.clear();
    slices.setScene(scene);
    rays.setScene(scene);
    CHECK(maxDifference(rays.render().colour, slices.render().colour) < kSameBlobs);
  }
}

TEST_CASE("Rays end where next to nothing is seen through", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense(glm::ivec3(40));
  ResolvedScene scene = plainScene(TransferFunction({{0, {kAlbedo, 0.1}}, {1, {kAlbedo, 1.5}}}),
                                   perspectiveCamera({70, 50, 90}, {20, 20, 20}, 0.6, 48), 0.5);
  const Picture whole = cast(*context, grid, scene);
  scene.sampling.saturation = 1e-3;
  const Picture ended = cast(*context, grid, scene);
  CHECK(maxDifference(ended.colour, whole.colour) < 1e-3);  // by its definition
  CHECK(ended.stats.fragments < whole.stats.fragments / 2);
  // Pixels that are full in front take no ray through what is behind.
  const std::uint64_t slot = whole.stats.textureBytes / whole.stats.brickSlots;
  const Picture streamed = cast(*context, grid, scene, {}, {.budgetBytes = 6 * slot});
  CHECK(maxDifference(streamed.colour, ended.colour) < 1e-3);
  CHECK(streamed.stats.fragments < whole.stats.fragments / 2);
}

TEST_CASE("Sparse and far volumes are walked through cell by cell", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  SECTION("balls far apart") {
    const ScalarGrid grid = makeSparse({0, 0, 0}, 2, 12, 300);
    Camera base;
    base.width = base.height = 64;
    for (const double azimuth : {0.0, 0.8, 2.9}) {
      ResolvedScene scene = plainScene(ramp(0.3), orbitCamera(grid.worldBounds(), azimuth, 0.3, base), 1);
      scene.bricks.interior = 8;
      const auto bricks = bricksFor(grid, scene);
      const Picture picture = RayCaster(*context, *bricks, scene).render();
      REQUIRE(largestAlpha(picture.colour) > 0.3);
      CHECK(maxDifference(picture.colour, SliceRenderer(*context, *bricks, scene).render().colour) < 2e-4);
    }
  }
  // No table holds all cells between these, so that each is a run of its own.
  SECTION("as far as indices go") {
    const int far = 1'900'000'000;
    const ScalarGrid grid = makeVoxels({{{0, 0, 0}, 1.0f}, {{far, 8, -8}, 1.0f}, {{40, far / 2, 3}, 1.0f}});
    for (const glm::dvec3& at : {glm::dvec3(0), glm::dvec3(far, 8, -8)}) {
      ResolvedScene scene = plainScene(ramp(2), orthographicCamera(at + glm::dvec3(0, 3, 10), at, 4, 24), 1);
      scene.sampling.spacing = 0.25;
      const Image picture = cast(*context, grid, scene).colour;
      CHECK(largestAlpha(picture) > 0.5);
      CHECK(maxDifference(picture, renderGrid(*context, grid, scene).colour) < kSameSegments);
    }
  }
  SECTION("a small voxel far from the origin") {
    const glm::ivec3 origin(1'000'000, -2'000'000, 500'000);
    const ScalarGrid grid = blobGrid(origin);
    for (Camera camera : smallCameras()) {
      camera.eye += glm::dvec3(origin);
      camera.lookAt += glm::dvec3(origin);
      checkRays(*context, grid, plainScene(ramp(0.6), camera, 0.5));
    }
  }
}

// As for slices, the estimate may be half of the true error or twice as large.
TEST_CASE("A progressive picture by rays says how far off it is", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  const ResolvedScene scene = plainScene(ramp(0.6), smallCameras()[1], 1);
  const auto bricks = bricksFor(grid, scene);
  RayCaster rays(*context, *bricks, scene);
  const ProgressivePicture picture = renderProgressive(rays, {.passes = 8, .pixelArea = false});
  const double error = rmsDifference(picture.picture.colour, renderReference(grid, scene).colour);
  INFO("estimate " << picture.error.total() << ", error " << error);
  CHECK(error < 2 * picture.error.total() + 2e-5);
  CHECK(picture.error.total() < 4 * error);
  CHECK(rays.scene() == scene);
}

TEST_CASE("Several rays a pixel are averaged", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = plainScene(ramp(0.6), smallCameras()[1], 0.5);
  scene.sampling.pixelSamples = 5;
  const auto bricks = bricksFor(grid, scene);
  CHECK(maxDifference(RayCaster(*context, *bricks, scene).render().colour,
                      SliceRenderer(*context, *bricks, scene).render().colour) < kSameBlobs);
}

TEST_CASE("A renderer of rays follows changes of its scene", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = plainScene(ramp(0.6), smallCameras()[0], 0.5);
  const auto bricks = bricksFor(grid, scene);
  RayCaster renderer(*context, *bricks, scene);
  renderer.render();
  CHECK_THROWS_WITH(
      [&] {
        renderer.setCamera(smallCameras()[1]);
        renderer.read();
      }(),
      "render: nothing was drawn since the scene changed");
  scene.camera = smallCameras()[1];
  for (int change = 0; change < 5; ++change) {
    if (change == 1) scene.transfer = ramp(0.9, 0.2);
    if (change == 2) scene.camera.width = 20;
    if (change == 3) scene.clipPlanes = {{0, 1, 0, -9}};
    if (change == 4) {
      scene.model = Model::cone;
      scene.method = Method::lightVolume;
    }
    INFO("change " << change);
    renderer.setScene(scene);
    const Picture picture = renderer.render();
    CHECK(maxDifference(picture.colour, RayCaster(*context, *bricks, scene).render().colour) < kSameBlobs);
    CHECK(picture.stats.uploadedBricks == 0);
  }
}

TEST_CASE("An empty volume gives rays nothing to see", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = plainScene(ramp(0.6, 5, 6), smallCameras()[0], 0.5);
  scene.background = glm::dvec3(0.25, 0.5, 1);
  const Picture picture = cast(*context, grid, scene, kLayers);
  CHECK(picture.stats.visibleBricks == 0);
  CHECK(picture.colour.at(3, 3)[1] == 0.5f);
  CHECK(std::isinf(*picture.depth.at(3, 3)));
}

TEST_CASE("Progress of rays is told and may end a picture", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = plainScene(ramp(0.6), smallCameras(200)[0], 0.5);
  const auto bricks = bricksFor(grid, scene);
  std::vector<double> shares;
  RenderOptions options;
  options.progress = [&](double share) { shares.push_back(share); };
  const Image picture = RayCaster(*context, *bricks, scene, options).render().colour;
  REQUIRE_FALSE(shares.empty());
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == Approx(1));
  CHECK(maxDifference(picture, RayCaster(*context, *bricks, scene).render().colour) == 0);
  options.progress = [](double) { throw InvalidArgument("enough"); };
  RayCaster stopped(*context, *bricks, scene, options);
  CHECK_THROWS_WITH(stopped.draw(), "enough");
  CHECK_THROWS_AS(stopped.read(), InvalidArgument);
}

TEST_CASE("What rays on OpenGL cannot render is refused in one line", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = plainScene(ramp(0.6), smallCameras()[0], 0.5);
  const auto bricks = bricksFor(grid, scene);
  scene.model = Model::cone;
  scene.method = Method::ordinates;
  CHECK_THROWS_WITH(RayCaster(*context, *bricks, scene),
                    "method: ordinates is one of slices; rays take light from a light volume");
  scene.model = Model::coneRay;
  CHECK_THROWS_WITH(
      RayCaster(*context, *bricks, scene),
      "model: cone-ray is integrated by the reference alone; rays render emission, cone, ambient and lights");
  scene.model = Model::emission;
  scene.camera.width = 1'000'000;
  CHECK_THROWS_WITH(RayCaster(*context, *bricks, scene), Catch::Contains("is beyond the driver's limit of"));
  scene.camera.width = 32;
  scene.sampling.spacing = 8;
  RayCaster thick(*context, *bricks, scene);
  CHECK_THROWS_WITH(thick.draw(), "render: segments of rays reach beyond the apron of 1 voxels");
  scene.sampling.spacing = 1e-7;
  RayCaster thin(*context, *bricks, scene);
  CHECK_THROWS_WITH(thin.draw(), Catch::Contains("segments of a ray"));
}
