// The reference's mean over the area of pixels: closed forms, and an error that Monte Carlo knows.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <vector>

#include "reference/reference_fixture.h"
#include "support/complaint.h"
#include "support/observed_order.h"
#include "support/seen_edge.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pixel_points.h"

using namespace umbrick;

namespace {

const glm::dvec3 kSheetAlbedo(0.9, 0.5, 0.2);
constexpr int kSize = 12;

ScalarGrid solidGrid() {
  return fieldGrid(
      {glm::ivec3(0), glm::ivec3(24)}, [](const glm::dvec3&) { return 1.0; }, glm::dmat4(1), 1);
}

ResolvedScene solidScene(bool perspective, double sigma_t, const HalfPlane& edge) {
  const glm::dvec3 eye(12, 13, 60), lookAt(12.5, 12, 12);
  ResolvedScene scene = plainScene(
      homogeneous(kSheetAlbedo, sigma_t),
      perspective ? perspectiveCamera(eye, lookAt, 0.3, kSize) : orthographicCamera(eye, lookAt, 14, kSize), 1);
  scene.clipPlanes = {planeSeenAs(edge, scene.camera)};
  return scene;
}

// Returns the share of a pixel's points inside the half-plane.
double shareOfPoints(const HalfPlane& edge, int x, int y, int count) {
  double inside = 0;
  for (const glm::dvec2& point : pixelPoints(count)) inside += edge.at(glm::dvec2(x, y) + point) >= 0;
  return inside / count;
}

}  // namespace

TEST_CASE("By quadrature, an edge is the share of a pixel's points, which tends to the area", "[reference]") {
  const ScalarGrid grid = solidGrid();
  for (const bool perspective : {false, true}) {
    std::vector<double> samples, errors;
    for (const int count : {1, 4, 16, 64}) {
      double square = 0;
      const std::vector<HalfPlane> edges = edgesThrough(kSize, 5);
      for (const HalfPlane& edge : edges) {
        ResolvedScene scene = solidScene(perspective, 1e3, edge);
        scene.sampling.pixelSamples = count;
        const Image picture = renderReference(grid, scene).colour;
        // A ray ends at a transmittance of 1e-6.
        for (int y = 0; y < kSize; ++y)
          for (int x = 0; x < kSize; ++x)
            CHECK(picture.at(x, y)[3] == Approx(shareOfPoints(edge, x, y, count)).margin(2e-6));
        square += std::pow(coverageError(edge, kSize, [&](int x, int y) { return picture.at(x, y)[3]; }), 2);
      }
      samples.push_back(count);
      errors.push_back(std::sqrt(square / static_cast<double>(edges.size())));
    }
    const double order = observedOrder(samples, errors);
    INFO("perspective " << perspective << ", order " << order);
    CHECK(order < -0.65);
  }
}

// A solid is seen a mean free path below its surface, however small the share of a pixel that it covers; its share
// of the background does not count.
TEST_CASE("At an edge, depth is that of what covers a part of the pixel", "[reference]") {
  const ScalarGrid grid = solidGrid();
  const HalfPlane edge = edgesThrough(kSize, 4)[1];
  const double sigma_t = 1e3;
  ResolvedScene scene = solidScene(false, sigma_t, edge);
  scene.background = glm::dvec3(0.3);
  scene.sampling.pixelSamples = 16;
  const glm::dvec3 forward = cameraFrame(scene.camera).forward;
  scene.clipPlanes.emplace_back(forward, -glm::dot(forward, scene.camera.eye) - 40);
  const ReferencePicture picture = renderReference(grid, scene);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double share = shareOfPoints(edge, x, y, 16);
      CHECK(*picture.visibility.at(x, y) == Approx(share).margin(2e-6));
      if (share > 0)
        CHECK(*picture.depth.at(x, y) == Approx(40 + 1 / sigma_t).margin(1e-4));
      else
        CHECK(std::isinf(*picture.depth.at(x, y)));
      CHECK(picture.colour.at(x, y)[0] == Approx(share * kSheetAlbedo[0] + (1 - share) * 0.3).margin(4e-6));
    }
}

// Each round has one path along each ray of a pixel. A solid stops every path, so nothing is left to chance: the
// picture is exact and known to be. A standard error of single paths would say that an edge is noise.
TEST_CASE("By Monte Carlo, rays of a pixel share its paths, and what they differ by is no noise", "[reference]") {
  const ScalarGrid grid = solidGrid();
  const HalfPlane edge = edgesThrough(kSize, 4)[2];
  ReferenceOptions options;
  options.integrator = Integrator::monteCarlo;
  options.samples = 39;  // two rounds of 16, and 7 paths too few for a third
  ResolvedScene scene = solidScene(true, 1e3, edge);
  scene.sampling.pixelSamples = 16;
  const ReferencePicture solid = renderReference(grid, scene, options);
  CHECK(solid.stats.eyeRays <= 32u * kSize * kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      CHECK(solid.colour.at(x, y)[3] == Approx(shareOfPoints(edge, x, y, 16)).margin(1e-6));
      CHECK(solid.standardError.at(x, y)[3] == Approx(0).margin(1e-6));
    }

  // In a translucent medium the error that is found is the one that is estimated, edge or not: over some 100 pixels
  // the mean of its square in units of the estimate is 1 to 0.15 (one deviation).
  scene = solidScene(true, 0.05, edge);
  scene.sampling.pixelSamples = 4;
  options.samples = 4000;
  const ReferencePicture noisy = renderReference(grid, scene, options);
  const ReferencePicture exact = renderReference(grid, scene);
  double sum = 0;
  int pixels = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double error = noisy.standardError.at(x, y)[3];
      if (error < 1e-4) continue;
      sum += std::pow((noisy.colour.at(x, y)[3] - exact.colour.at(x, y)[3]) / error, 2);
      ++pixels;
    }
  INFO(pixels << " pixels");
  CHECK(pixels > 50);
  CHECK(sum / pixels > 0.5);
  CHECK(sum / pixels < 1.6);

  options.samples = 7;
  CHECK_THAT(complaint<InvalidArgument>([&] { renderReference(grid, scene, options); }),
             Catch::Contains("samples is 7, must be at least 8, two for each sample of a pixel"));
}
