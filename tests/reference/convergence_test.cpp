// How fast the reference converges in each of its discretisations. Etiene et al. 2014, doi:10.1109/TVCG.2013.90
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "reference/reference_fixture.h"
#include "support/observed_order.h"
#include "support/smooth_scene.h"

using namespace umbrick;

namespace {

// Returns soft balls in front of each other, so that what they hide of a cone has edges.
ScalarGrid balls() { return makeSparse(glm::ivec3(0), 3, 40, 64); }
ResolvedScene ballScene(int size) {
  ResolvedScene scene = plainScene(TransferFunction({{0.1, {glm::dvec3(1), 0}}, {0.2, {glm::dvec3(1), 4}}}),
                                   perspectiveCamera({110, -60, 100}, {32, 32, 32}, 0.7, size), 1);
  scene.model = Model::cone;
  return scene;
}

}  // namespace

// V is taken at one place per step, the centre of its scattering. This is of second order where V is smooth.
TEST_CASE("V converges with the given step at second order", "[reference][slow]") {
  const ScalarGrid grid = smoothGrid(1);
  const ResolvedScene scene = smoothScene(Model::cone, 10);
  ReferenceOptions options;
  options.directions = 24;
  options.tolerance = 1e-6;
  const ReferencePicture exact = renderReference(grid, scene, options);
  std::vector<double> steps, errors;
  for (const double step : {8.0, 4.0, 2.0, 1.0}) {
    options.step = step;
    steps.push_back(step);
    errors.push_back(rmsDifference(renderReference(grid, scene, options).colour, exact.colour));
  }
  INFO(errors[0] << ' ' << errors[1] << ' ' << errors[2] << ' ' << errors[3]);
  CHECK(observedOrder(steps, errors) == Approx(2).margin(0.3));
  CHECK(errors.back() < 2e-4);
}

TEST_CASE("The error stays near the tolerance that is asked for", "[reference]") {
  const ScalarGrid grid = balls();
  const ResolvedScene scene = ballScene(10);
  ReferenceOptions options;
  options.directions = 64;
  options.tolerance = 1e-6;
  const ReferencePicture exact = renderReference(grid, scene, options);
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    options.tolerance = tolerance;
    const ReferencePicture picture = renderReference(grid, scene, options);
    // The tolerance is that of a stretch. A ray has some ten stretches that scatter, with errors of either sign.
    CHECK(rmsDifference(picture.colour, exact.colour) < 3 * tolerance);
    CHECK(picture.stats.samples < exact.stats.samples);
  }
}

// Where the medium is smooth, rings at Gauss nodes are better than any power. Where edges cross the cone, each edge
// cuts about sqrt(K) of the K strata of share 1 / K, so the error falls as K^(-3/4).
TEST_CASE("V converges with the number of directions", "[reference][slow]") {
  const std::vector<double> counts{8, 32, 128, 512};
  const auto errorsOf = [&](const ScalarGrid& grid, const ResolvedScene& scene) {
    ReferenceOptions options;
    options.step = 4;  // voxels; the same places for every count
    options.directions = 8192;
    const ReferencePicture exact = renderReference(grid, scene, options);
    std::vector<double> errors;
    for (const double count : counts) {
      options.directions = static_cast<int>(count);
      errors.push_back(rmsDifference(renderReference(grid, scene, options).colour, exact.colour));
    }
    return errors;
  };
  const std::vector<double> soft = errorsOf(smoothGrid(1), smoothScene(Model::cone, 6));
  INFO("soft " << soft[0] << ' ' << soft[1] << ' ' << soft[2] << ' ' << soft[3]);
  CHECK(observedOrder(counts, soft) < -1);
  const std::vector<double> hard = errorsOf(balls(), ballScene(10));
  INFO("hard " << hard[0] << ' ' << hard[1] << ' ' << hard[2] << ' ' << hard[3]);
  CHECK(observedOrder(counts, hard) == Approx(-0.75).margin(0.25));
}

// Interpolation replaces a smooth field by one that is h^2 / 8 of its curvature away.
TEST_CASE("Pictures converge with the voxel size at second order", "[reference][slow]") {
  for (const Model model : {Model::emission, Model::cone, Model::ambient}) {
    INFO(modelName(model));
    const ResolvedScene scene = smoothScene(model, 8);
    ReferenceOptions options;
    options.directions = 24;
    options.tolerance = 1e-5;
    const auto render = [&](double h) { return renderReference(smoothGrid(h), scene, options).colour; };
    const Image exact = render(0.25);
    const std::vector<double> sizes{3, 1.5, 1};
    std::vector<double> errors;
    // The error of the finest picture, with which the others are compared, is a sixteenth of the last error.
    for (const double h : sizes) errors.push_back(rmsDifference(render(h), exact));
    INFO(errors[0] << ' ' << errors[1] << ' ' << errors[2]);
    CHECK(observedOrder(sizes, errors) == Approx(2).margin(0.3));
  }
}

// A pixel is the ray through its centre, and between pixels a picture is what linear interpolation makes of it.
TEST_CASE("Pictures converge with the pixel size at second order", "[reference][slow]") {
  const ScalarGrid grid = smoothGrid(1);
  ResolvedScene scene = smoothScene(Model::emission, 128);
  scene.camera.fov = 0.4;
  const Image exact = renderReference(grid, scene).colour;
  std::vector<double> sizes, errors;
  for (const int factor : {16, 8, 4}) {
    scene.camera.width = scene.camera.height = 128 / factor;
    sizes.push_back(factor);
    errors.push_back(rmsDifference(enlarge(renderReference(grid, scene).colour, factor), exact));
  }
  INFO(errors[0] << ' ' << errors[1] << ' ' << errors[2]);
  CHECK(observedOrder(sizes, errors) == Approx(2).margin(0.3));
}

// With twice the paths there is half the variance.
TEST_CASE("Monte Carlo converges with the square root of its paths", "[reference][slow]") {
  const ScalarGrid grid = balls();
  const ResolvedScene scene = ballScene(10);
  ReferenceOptions options;
  options.directions = 4096;
  const ReferencePicture exact = renderReference(grid, scene, options);
  options.integrator = Integrator::monteCarlo;
  std::vector<double> counts, errors;
  for (const int samples : {16, 64, 256, 1024}) {
    options.samples = samples;
    counts.push_back(samples);
    errors.push_back(rmsDifference(renderReference(grid, scene, options).colour, exact.colour));
  }
  CHECK(observedOrder(counts, errors) == Approx(-0.5).margin(0.1));
}
