// Progressive pictures by techniques on the CPU: what they converge to, and what they say of their own error.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "sweep/picture_of_grid.h"
#include "umbrick/draw/progressive.h"

using namespace umbrick;

namespace {

ResolvedScene unlitScene(const Camera& camera, double spacing) {
  ResolvedScene scene = plainScene(ramp(0.6), camera, spacing);
  scene.model = Model::emission;
  return scene;
}

std::unique_ptr<Renderer> rendererOf(Technique technique, const Bricks& bricks, const ResolvedScene& scene) {
  if (technique == Technique::rays) return std::make_unique<RayRenderer>(bricks, scene);
  return std::make_unique<ShearWarpRenderer>(bricks, scene);
}

// Returns the RMS difference of R, G and B, as the estimates are meant.
double rmsOfColour(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (i % 4 != 3) sum += std::pow(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]), 2);
  return std::sqrt(sum / (0.75 * static_cast<double>(a.pixels.size())));
}

}  // namespace

// The estimate takes errors to fall with an order between 1 and 2: it is 1.7 times too low where they fall with order
// 1, 1.7 times too high with order 2, and 4 times too high with order 3, which a cubic warp of a smooth picture can
// have.
TEST_CASE("A picture of the CPU knows its systematic error", "[sweep][cpu][progressive]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras(40))
    for (const Technique technique : kCpuTechniques)
      for (const double spacing : {4.0, 1.0, 0.5, 0.25}) {  // of 4 they take samples a voxel apart, too
        const ResolvedScene scene = unlitScene(camera, spacing);
        const Image exact = renderReference(grid, scene).colour;
        const auto bricks = cpuBricksFor(grid, scene);
        const auto renderer = rendererOf(technique, *bricks, scene);
        const ProgressivePicture picture = renderProgressive(*renderer, {.passes = 4, .pixelArea = false});
        const double error = rmsOfColour(picture.picture.colour, exact);
        INFO(techniqueName(technique) << " at " << spacing << ": says " << picture.error.systematic << ", is "
                                      << error);
        CHECK(picture.error.statistical == 0);  // all samples are the same
        CHECK(picture.error.systematic > error / 1.8);
        CHECK(picture.error.systematic < (technique == Technique::rays ? 2.2 : 4.1) * error + 1e-5);
        CHECK(renderer->scene() == scene);
      }
}

TEST_CASE("A target error is reached on the CPU by samples that are closer", "[sweep][cpu][progressive]") {
  const ScalarGrid grid = blobGrid();
  const ResolvedScene scene = unlitScene(smallCameras(40)[1], 1);
  const Image exact = renderReference(grid, scene).colour;
  const auto bricks = cpuBricksFor(grid, scene);
  for (const Technique technique : kCpuTechniques) {
    const auto renderer = rendererOf(technique, *bricks, scene);
    const ProgressiveOptions coarse{.passes = 4, .pixelArea = false};
    const double target = renderProgressive(*renderer, coarse).error.total() / 5;
    ProgressiveOptions options{.passes = 40, .targetError = target, .refine = true, .pixelArea = false};
    const ProgressivePicture picture = renderProgressive(*renderer, options);
    INFO(techniqueName(technique) << ": target " << target << ", says " << picture.error.total() << ", is "
                                  << rmsOfColour(picture.picture.colour, exact));
    CHECK(picture.reachedTarget);
    CHECK(picture.scene.sampling.spacing < 0.6);
    CHECK(rmsOfColour(picture.picture.colour, exact) < 1.8 * target);
    CHECK(renderer->scene() == scene);
    // No sample is closer than an eighth of a voxel, so that what cannot be reached ends.
    options.targetError = 1e-9;
    options.passes = 1000;
    const ProgressivePicture finest = renderProgressive(*renderer, options);
    CHECK_FALSE(finest.reachedTarget);
    CHECK(finest.passes < 100);
    CHECK(finest.scene.sampling.spacing >= 0.125);
  }
}

// Places in pixels are the only thing that samples without light differ in.
TEST_CASE("Samples of a picture of the CPU average over the area of pixels", "[sweep][cpu][progressive]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = unlitScene(smallCameras(16)[0], 0.5);
  const auto bricks = cpuBricksFor(grid, scene);
  RayRenderer renderer(*bricks, scene);
  std::vector<double> errors, said;
  ResolvedScene many = scene;
  many.sampling.pixelSamples = 1024;
  const Image area = RayRenderer(*bricks, many).render().colour;
  renderProgressive(renderer, {.passes = 64, .seed = 3}, [&](const ProgressivePicture& picture) {
    if (picture.passes == 4 || picture.passes == 64) {
      errors.push_back(rmsOfColour(picture.picture.colour, area));
      said.push_back(picture.error.statistical);
    }
    return true;
  });
  REQUIRE(errors.size() == 2);
  INFO("errors " << errors[0] << ", " << errors[1] << ", said " << said[0] << ", " << said[1]);
  CHECK(errors[1] < 0.25 * errors[0]);  // at least as the root of the number of samples
  for (const std::size_t i : {0u, 1u}) {
    CHECK(said[i] > errors[i] / 3);
    CHECK(said[i] < 3 * errors[i]);
  }
}

TEST_CASE("Samples of other directions average to finer light on the CPU", "[sweep][cpu][progressive]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = plainScene(ramp(0.8), smallCameras(24)[1], 0.5);
  scene.model = Model::cone;
  scene.method = Method::lightVolume;
  scene.occlusion.ordinates.directions = 5;
  scene.occlusion.aperture = 60 * kDegree;
  ResolvedScene fine = scene;
  fine.occlusion.ordinates.directions = 256;
  const auto bricks = cpuBricksFor(grid, scene);
  const Image limit = RayRenderer(*bricks, fine).render().colour;
  RayRenderer renderer(*bricks, scene);
  const double single = rmsOfColour(renderer.render().colour, limit);
  const ProgressivePicture mean = renderProgressive(renderer, {.passes = 16, .pixelArea = false});
  const double error = rmsOfColour(mean.picture.colour, limit);
  INFO("error " << error << " of 16 samples, " << single << " of one, said " << mean.error.statistical);
  CHECK(error < 0.4 * single);
  CHECK(mean.error.statistical > error / 3);
  CHECK(mean.error.statistical < 3 * error);
  // The same seed gives the same picture.
  const ProgressivePicture again = renderProgressive(renderer, {.passes = 16, .pixelArea = false});
  CHECK((again.picture.colour.pixels == mean.picture.colour.pixels));
}

// What voxels do to light falls with an order between 1 and 2, as what samples do to a ray: the estimate is up to 1.7
// times too low or too high, and both kinds of error may have one sign, so that they add where it takes the root of
// the sum of squares.
TEST_CASE("A picture of the CPU knows what the voxels of its light leave out",
          "[sweep][cpu][progressive][light-volume]") {
  const ScalarGrid grid = blobGrid();
  ReferenceOptions options;
  options.directions = 128;
  for (const Model model : {Model::cone, Model::ambient}) {
    ResolvedScene scene = plainScene(ramp(0.8), smallCameras(20)[1], 0.5);
    scene.model = model;
    scene.method = Method::lightVolume;
    scene.occlusion.aperture = 60 * kDegree;
    scene.occlusion.ordinates.directions = 32;
    const Image exact = renderReference(grid, scene, options).colour;
    const auto bricks = cpuBricksFor(grid, scene);
    for (const Technique technique : kCpuTechniques)
      for (const int lightSpacing : {0, 2}) {
        scene.occlusion.ordinates.lightSpacing = lightSpacing;
        const auto renderer = rendererOf(technique, *bricks, scene);
        const ProgressivePicture picture = renderProgressive(*renderer, {.passes = 4, .pixelArea = false});
        const double error = rmsOfColour(picture.picture.colour, exact);
        INFO(techniqueName(technique) << ", light " << lightSpacing << ": says " << picture.error.statistical << " and "
                                      << picture.error.systematic << ", is " << error);
        CHECK(picture.error.total() > error / 1.8);
        CHECK(picture.error.total() < 2.2 * error);
        CHECK(renderer->scene() == scene);
      }
  }
}
