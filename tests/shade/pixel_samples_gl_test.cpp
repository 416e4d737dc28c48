// Pixels have an area: the mean over several rays of a pixel, against closed forms, the reference and itself.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <vector>

#include "shade/hard_case.h"
#include "shade/progressive_slices.h"
#include "support/complaint.h"
#include "support/observed_order.h"
#include "support/seen_edge.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pixel_points.h"

using namespace umbrick;

namespace {

constexpr int kSize = 16;

// Returns a solid layer, farther across than the picture, whose edges are what its clip planes make them.
ResolvedScene solidScene(bool perspective) {
  ResolvedScene scene = plainScene(TransferFunction({{0, {kAlbedo, 0}}, {1, {kAlbedo, 8}}}),
                                   perspective ? perspectiveCamera({16, 16, 90}, {17, 15, 0}, 0.4, kSize)
                                               : orthographicCamera({16, 16, 90}, {17, 15, 0}, 30, kSize),
                                   1.7);
  scene.clipPlanes = {{0, 0, 1, -34}, {0, 0, -1, 50}};
  return scene;
}
FieldBricks solidVolume(const ResolvedScene& scene) {
  return fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-32, -32, 0), glm::ivec3(63, 63, 63)});
}

// Returns the largest difference of a picture to another one that lies (right, up) pixels beside it.
double shiftedDifference(const Image& image, const Image& other, int right, int up) {
  double largest = 0;
  for (int y = std::max(0, -up); y < image.height - std::max(0, up); ++y)
    for (int x = std::max(0, -right); x < image.width - std::max(0, right); ++x)
      for (int c = 0; c < image.channels; ++c)
        largest = std::max(largest, std::abs(static_cast<double>(image.at(x, y)[c]) - other.at(x + right, y + up)[c]));
  return largest;
}

}  // namespace

// One ray of a pixel is off by up to half of the edge's step. Points beside lines of all directions are off by their
// number to the power -3/4, see pixel_points_test.
TEST_CASE("The edge of a solid tends to the share of each pixel that it covers", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const std::vector<HalfPlane> edges = edgesThrough(kSize, 6);
  for (const bool perspective : {false, true}) {
    ResolvedScene scene = solidScene(perspective);
    const FieldBricks volume = solidVolume(scene);
    SliceRenderer renderer(*context, volume, scene);
    std::vector<double> samples, errors;
    for (const int count : {1, 4, 16, 64}) {
      double square = 0;
      for (const HalfPlane& edge : edges) {
        ResolvedScene cut = scene;
        cut.sampling.pixelSamples = count;
        cut.clipPlanes.push_back(planeSeenAs(edge, scene.camera));
        renderer.setScene(cut);
        const Image picture = renderer.render().colour;
        square += std::pow(coverageError(edge, kSize, [&](int x, int y) { return picture.at(x, y)[3]; }), 2);
        for (int y = 0; y < kSize; ++y)
          for (int x = 0; x < kSize; ++x) {
            // Where no point lies on the edge the picture is the share of the points inside, to single precision.
            int inside = 0;
            double nearest = 1;
            for (const glm::dvec2& point : pixelPoints(count)) {
              const double distance = edge.at(glm::dvec2(x, y) + point);
              inside += distance >= 0;
              nearest = std::min(nearest, std::abs(distance));
            }
            if (nearest < 1e-3) continue;
            INFO("perspective " << perspective << ", " << count << " samples, pixel " << x << " " << y);
            CHECK(picture.at(x, y)[3] == Approx(static_cast<double>(inside) / count).margin(1e-6));
            CHECK(picture.at(x, y)[0] == Approx(kAlbedo.r * inside / count).margin(1e-6));
          }
      }
      samples.push_back(count);
      errors.push_back(std::sqrt(square / static_cast<double>(edges.size())));
    }
    const double order = observedOrder(samples, errors);
    INFO("perspective " << perspective << ", order " << order << ", errors " << errors[0] << " to " << errors[3]);
    CHECK(order < -0.65);
    CHECK(errors[3] < 0.02);
  }
}

// Rays through the centres of pixels miss a sheet that is a fifth of a pixel wide, or take it for a whole pixel.
TEST_CASE("A sheet thinner than a pixel has the opacity of the share that it covers", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = solidScene(false);
  const double width = 0.2;
  HalfPlane left = edgesThrough(kSize, 5)[1], right{-left.normal, width - left.offset};
  scene.clipPlanes.push_back(planeSeenAs(left, scene.camera));
  scene.clipPlanes.push_back(planeSeenAs(right, scene.camera));
  const FieldBricks volume = solidVolume(scene);
  std::vector<double> errors;
  for (const int count : {1, 64}) {
    scene.sampling.pixelSamples = count;
    const Image picture = renderPicture(*context, volume, scene).colour;
    double square = 0, sum = 0, exact = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double share = coverage(left, x, y) - (1 - coverage(right, x, y));
        square += std::pow(picture.at(x, y)[3] - share, 2);
        sum += picture.at(x, y)[3];
        exact += share;
      }
    errors.push_back(std::sqrt(square / (kSize * kSize)));
    INFO(count << " samples, found " << sum << ", covered " << exact);
    if (count > 1) CHECK(sum == Approx(exact).epsilon(0.05));
  }
  INFO("error " << errors[0] << " to " << errors[1]);
  CHECK(errors[1] < 0.1 * errors[0]);
}

// A shift by whole pixels only renames them. The picture is wide enough for the medium, and for how far it darkens what
// is beside it, not to reach its edges: dos knows occlusion on the screen alone.
TEST_CASE("A picture through a place one pixel away is the same picture one pixel away", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (Camera camera : blobCameras()) {
    camera.fov = 1.4;
    camera.viewHeight = 60;
    for (const auto& [model, method] : {std::pair{Model::emission, Method::ordinates},
                                        {Model::cone, Method::dos},
                                        {Model::cone, Method::ordinates}}) {
      ResolvedScene scene = plainScene(ramp(0.4), camera, 0.8);
      scene.model = model;
      scene.method = method;
      scene.occlusion.aperture = 0.5;
      scene.occlusion.ordinates.directions = 4;
      const FieldBricks volume = fieldFor(scene, blobs, kBlock);
      SliceRenderer renderer(*context, volume, scene, kLayers);
      const Picture plain = renderer.render();
      RenderSample sample;
      sample.pixel = {1.5, -0.5};
      const Picture moved = renderer.render(sample);
      INFO("perspective " << (camera.projection == Projection::perspective) << ", " << modelName(model) << ", "
                          << methodName(method));
      CHECK(largestAlpha(plain.colour) > 0.5f);
      // Screen points and atlas coordinates are rounded anew: 1e-6 of a voxel, of a medium of 0.4 per voxel.
      CHECK(shiftedDifference(moved.colour, plain.colour, 1, -1) < 2e-5);
      CHECK(shiftedDifference(moved.visibility, plain.visibility, 1, -1) < 2e-5);
      CHECK(maxDifference(moved.colour, plain.colour) > 0.01);
    }
  }
}

TEST_CASE("Several samples are the mean of their pictures, and one is the picture through the centres", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = plainScene(ramp(0.4), blobCameras()[1], 0.8);
  scene.model = Model::cone;
  const FieldBricks volume = fieldFor(scene, blobs, kBlock);
  SliceRenderer renderer(*context, volume, scene, kLayers);
  const Picture centre = renderer.render();
  RenderSample at;
  at.pixel = glm::dvec2(0.5);
  CHECK((renderer.render(at).colour.pixels == centre.colour.pixels));

  std::vector<Picture> pictures;
  for (const glm::dvec2& point : pixelPoints(5)) {
    at.pixel = point;
    pictures.push_back(renderer.render(at));
  }
  SamplingOptions sampling = scene.sampling;
  sampling.pixelSamples = 5;
  renderer.setSampling(sampling);
  const Picture mean = renderer.render();
  std::uint64_t fragments = 0;
  for (const Picture& picture : pictures) fragments += picture.stats.fragments;
  CHECK(mean.stats.fragments == fragments);
  CHECK(mean.stats.uploadedBricks == 0);  // bricks stay resident
  for (std::size_t i = 0; i < mean.colour.pixels.size(); ++i) {
    double sum = 0;
    for (const Picture& picture : pictures) sum += picture.colour.pixels[i];
    CHECK(mean.colour.pixels[i] == static_cast<float>(sum / 5));
  }
  // Visibility is weighted by opacity already, and depth is so in the mean.
  for (std::size_t i = 0; i < mean.depth.pixels.size(); ++i) {
    double visibility = 0, opacity = 0, depth = 0;
    for (const Picture& picture : pictures) {
      visibility += picture.visibility.pixels[i] / 5;
      const double alpha = picture.colour.pixels[4 * i + 3];
      opacity += alpha;
      if (alpha > 0) depth += alpha * picture.depth.pixels[i];
    }
    CHECK(mean.visibility.pixels[i] == Approx(visibility).margin(1e-6));
    if (opacity > 0)
      CHECK(mean.depth.pixels[i] == Approx(depth / opacity).epsilon(1e-5));
    else
      CHECK(std::isinf(mean.depth.pixels[i]));
  }
}

// With a background, the picture's alpha does not tell how much of a pixel is covered, but depth is weighted by that.
TEST_CASE("Area means agree with the reference, layers too, with and without a background", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(25), glm::ivec3(0), smallBlobs);
  for (const Camera& camera : smallCameras(24))
    for (const bool background : {false, true}) {
      ResolvedScene scene = plainScene(ramp(6, 0.3, 0.31), camera, 0.1);  // hard edges
      if (background) scene.background = glm::dvec3(0.2, 0.4, 0.9);
      INFO("perspective " << (camera.projection == Projection::perspective) << ", background " << background);
      std::vector<double> apart;
      for (const int count : {1, 9}) {
        scene.sampling.pixelSamples = count;
        const ReferencePicture exact = renderReference(grid, scene);
        const Picture picture = renderGrid(*context, grid, scene, kLayers);
        apart.push_back(rmsDifference(picture.colour, exact.colour));
        CHECK(rmsDifference(picture.visibility, exact.visibility) < 3e-3);
        double square = 0, pixels = 0;
        for (std::size_t i = 0; i < exact.depth.pixels.size(); ++i) {
          CHECK(picture.opacity.pixels[i] == Approx(exact.visibility.pixels[i]).margin(0.05));  // emission: V = A
          if (exact.visibility.pixels[i] < 0.05f) continue;
          square += std::pow(picture.depth.pixels[i] - exact.depth.pixels[i], 2);
          ++pixels;
        }
        INFO(count << " samples: colour " << apart.back() << ", depth " << std::sqrt(square / pixels));
        CHECK(pixels > 40);
        CHECK(std::sqrt(square / pixels) < 0.1);  // a slab
      }
      INFO("colour apart by " << apart[0] << " and " << apart[1]);
      CHECK(apart[1] < 1.2 * apart[0] + 1e-4);  // errors of slabs do not grow by averaging
      CHECK(apart[1] < 5e-4);
    }
}

// All pixels of a pass share their place, so that one picture may be off by twice what it is off on average: over 200
// seeds and edges of all directions that is 0.21, 0.067 and 0.030 for 4, 16 and 64 passes. Here are four of each.
TEST_CASE("A progressive picture tends to the mean over pixels, or stays at their centres", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = solidScene(true);
  scene.method = Method::ordinates;
  scene.model = Model::lights;
  scene.lights = {{LightFrame::view, ListedLight{{{{0.5, -0.3, 0.7}, 1, glm::dvec3(1)}}}}};
  const FieldBricks volume = solidVolume(coarserScene(scene));
  ResidentVolume resident(*context, volume, atlasOptions(scene, volume));
  const std::vector<double> passes{4, 16, 64};
  std::vector<double> squares(3);
  ResolvedScene cut = scene;
  const std::vector<HalfPlane> edges = edgesThrough(kSize, 4);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    cut = scene;
    cut.clipPlanes.push_back(planeSeenAs(edges[i], scene.camera));
    // A scene that names a number of samples is no other: each pass is one.
    cut.sampling.pixelSamples = 8;
    const ProgressivePicture area =
        progressiveSlices(resident, cut, {.passes = 64, .seed = i + 1}, {}, [&](const ProgressivePicture& picture) {
          const Image& colour = picture.picture.colour;
          for (std::size_t n = 0; n < 3; ++n)
            if (picture.passes == passes[n])
              squares[n] +=
                  std::pow(coverageError(edges[i], kSize, [&](int x, int y) { return colour.at(x, y)[3]; }), 2);
          return true;
        });
    CHECK(area.scene == cut);
  }
  std::vector<double> errors;
  for (const double square : squares) errors.push_back(std::sqrt(square / static_cast<double>(edges.size())));
  const double order = observedOrder(passes, errors);
  INFO("order " << order << ", errors " << errors[0] << ", " << errors[1] << ", " << errors[2]);
  CHECK(order < -0.5);
  CHECK(errors.back() < 0.06);

  cut.sampling.pixelSamples = 1;
  const ProgressivePicture centres = progressiveSlices(resident, cut, {.passes = 4, .pixelArea = false});
  const Image plain = SliceRenderer(resident, cut).render().colour;
  for (std::size_t i = 3; i < plain.pixels.size(); i += 4)
    CHECK(centres.picture.colour.pixels[i] == Approx(plain.pixels[i]).margin(1e-5));
}

TEST_CASE("A pixel without samples is refused by the name of its field", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const int count : {0, -1, 5000}) {
    ResolvedScene scene = solidScene(false);
    scene.sampling.pixelSamples = count;
    CHECK_THAT(complaint<InvalidArgument>([&] { validateScene(scene); }), Catch::Contains("sampling.pixelSamples"));
  }
}
