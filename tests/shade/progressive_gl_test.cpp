// Pictures that are the mean of samples: what they converge to, how fast, and how well they know their own error.
// SPDX-License-Identifier: Apache-2.0
#include "shade/progressive_slices.h"

#include <catch2/catch.hpp>
#include <limits>
#include <optional>

#include "shade/grid_picture.h"
#include "support/complaint.h"
#include "support/courtyard.h"
#include "support/observed_order.h"
#include "umbrick/reference/reference.h"

using namespace umbrick;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the courtyard in few pixels, slabs and directions.
ResolvedScene smallScene(int slices = 16, int directions = 3) {
  ResolvedScene scene = courtyardScene(60, slices);
  scene.camera.width = scene.camera.height = 24;
  scene.method = Method::ordinates;
  scene.occlusion.ordinates.directions = directions;
  return scene;
}

// Returns a layer of depth 40.3 to 56.2, far wider than the picture, under light from one direction: nothing in it
// depends on directions, and slabs are exact (see ordinates_gl_test).
ResolvedScene layerScene(bool perspective, double eyeDepth = 40.3) {
  const double z = 50 + eyeDepth;
  ResolvedScene scene = plainScene(TransferFunction({{0, {{1, 0.5, 0.25}, 0}}, {1, {{1, 0.5, 0.25}, 0.11}}}),
                                   perspective ? perspectiveCamera({16, 16, z}, {16, 16, 0}, 0.7, 16)
                                               : orthographicCamera({16, 16, z}, {16, 16, 0}, 30, 16),
                                   1.7);
  scene.camera.up = {0, 1, 0};
  scene.method = Method::ordinates;
  scene.model = Model::lights;
  scene.lights = {{LightFrame::view, ListedLight{{{{0.5, -0.3, 0.7}, 1, glm::dvec3(1)}}}}};
  scene.clipPlanes = {{0, 0, 1, -34.1}, {0, 0, -1, 50}};
  return scene;
}

FieldBricks layerVolume(const ResolvedScene& scene) {
  return fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-64, -64, 0), glm::ivec3(95, 95, 63)});
}

// Returns bricks whose apron also fits slabs that are twice as thick.
std::unique_ptr<Bricks> bricksForPasses(const ScalarGrid& grid, const ResolvedScene& scene) {
  return bricksFor(grid, coarserScene(scene));
}

// Returns the RMS difference of R, G and B, as the estimates are meant.
double rmsOfRgb(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (i % 4 != 3) sum += std::pow(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]), 2);
  return std::sqrt(sum / (0.75 * static_cast<double>(a.pixels.size())));
}

double rootMeanSquare(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number * number;
  return std::sqrt(sum / static_cast<double>(numbers.size()));
}

}  // namespace

TEST_CASE("A homogeneous layer looks the same whatever the sample", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const bool perspective : {false, true}) {
    const ResolvedScene scene = layerScene(perspective);
    const FieldBricks volume = layerVolume(scene);
    SliceRenderer renderer(*context, volume, scene, kLayers);
    const Picture plain = renderer.render();
    const double depth = renderer.sliceDepths().front();
    CHECK(plain.colour.at(8, 8)[0] > 0.3f);
    for (const double phase : {0.001, 0.2, 0.5, 0.71, 0.999})
      for (const glm::dvec2& shift : {glm::dvec2(0), glm::dvec2(0.3, 0.8)})
        for (const glm::dvec2& rounding : {glm::dvec2(0.5), glm::dvec2(0, 0.9)}) {
          const Picture picture = renderer.render(
              scene.camera, {.lights = {}, .phase = phase, .latticeShift = shift, .rounding = rounding});
          INFO("perspective " << perspective << ", phase " << phase << ", shift " << shift.x << ", rounding "
                              << rounding.x);
          // The slices do lie at other depths.
          const double steps = (renderer.sliceDepths().front() - depth) / scene.sampling.spacing - (phase - 0.5);
          CHECK(steps == Approx(std::round(steps)).margin(1e-9));
          // For each of the two pictures, a slab takes a few roundings, and planes are placed to 1e-6 of a slab, as in
          // the closed form of ordinates_gl_test.
          const double slabs = 16 / scene.sampling.spacing + 2;
          const double tolerance = 2 * (slabs * 10 * kFloatRounding + 4e-6 * 0.11 * scene.sampling.spacing);
          CHECK(maxDifference(picture.colour, plain.colour) < tolerance);
          CHECK(maxDifference(picture.visibility, plain.visibility) < tolerance);
        }
  }
}

TEST_CASE("A phase is ignored where the eye is inside", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ResolvedScene scene = layerScene(true, -5);  // the eye is 5 units deep in the layer
  const FieldBricks volume = layerVolume(scene);
  SliceRenderer renderer(*context, volume, scene);
  const Picture plain = renderer.render();
  const std::vector<double> depths = renderer.sliceDepths();
  CHECK(depths.front() == 0.5 * scene.sampling.spacing);
  for (const double phase : {0.1, 0.9}) {
    CHECK((renderer.render(scene.camera, {.lights = {}, .phase = phase}).colour.pixels == plain.colour.pixels));
    CHECK(renderer.sliceDepths() == depths);
  }
}

TEST_CASE("The picture after n samples is the mean of n pictures", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  ResolvedScene scene = smallScene();
  const auto volume = bricksForPasses(grid, scene);
  // Each sample is the difference that it makes to the sum of the samples.
  std::vector<Image> means;
  const ProgressivePicture all =
      progressiveSlices(*context, *volume, scene, {.passes = 6}, kLayers, [&](const ProgressivePicture& picture) {
        means.push_back(picture.picture.colour);
        CHECK(picture.passes == static_cast<int>(means.size()));
        CHECK(std::isfinite(picture.error.statistical) == (means.size() >= kStreams));
        CHECK(std::isfinite(picture.error.systematic) == (means.size() >= kStreams));
        return true;
      });
  CHECK(all.passes == 6);
  REQUIRE(means.size() == 6);
  CHECK((means.back().pixels == all.picture.colour.pixels));
  CHECK(all.scene == scene);
  CHECK_FALSE(all.reachedTarget);
  double least = 1, most = 0, change = 0;
  for (std::size_t i = 0; i < means[0].pixels.size(); ++i)
    for (std::size_t n = 1; n < means.size(); ++n) {
      const double one =
          (n + 1) * static_cast<double>(means[n].pixels[i]) - n * static_cast<double>(means[n - 1].pixels[i]);
      least = std::min(least, one);
      most = std::max(most, one);
      change = std::max(change, std::abs(one - means[0].pixels[i]));
    }
  // Each sample is a picture: in [0, 1] except for 11 roundings, and not the same as the first.
  CHECK(least > -11 * kFloatRounding);
  CHECK(most < 1 + 11 * kFloatRounding);
  CHECK(change > 0.1);
}

TEST_CASE("Layers are averaged as the picture is", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  ResolvedScene scene = smallScene();
  const auto volume = bricksForPasses(grid, scene);
  const Picture picture = progressiveSlices(*context, *volume, scene, {.passes = 8}, kLayers).picture;
  REQUIRE(picture.visibility.pixels.size() == picture.colour.pixels.size() / 4);
  REQUIRE(picture.depth.pixels.size() == picture.colour.pixels.size() / 4);
  // V depends on the sample no more than the picture does: with one albedo it is the picture.
  scene.transfer = TransferFunction({{0, {glm::dvec3(0.5), 0}}, {1, {glm::dvec3(0.5), 3}}});
  const Picture grey = progressiveSlices(*context, *volume, scene, {.passes = 8}, kLayers).picture;
  double worst = 0;
  for (std::size_t i = 0; i < grey.visibility.pixels.size(); ++i)
    worst = std::max(worst, std::abs(grey.visibility.pixels[i] - 2.0 * grey.colour.pixels[4 * i]));
  // sigma_s / sigma_t comes from a table of single precision, 16 slabs of which are blended.
  CHECK(worst < 16 * 4 * kFloatRounding);
  // Depth is a mean weighted by opacity: over opaque pixels it is on average that of a single picture to within
  // half a slab.
  const Picture single = renderPicture(*context, *volume, scene, kLayers);
  double apart = 0, opaque = 0;
  for (std::size_t i = 0; i < single.depth.pixels.size(); ++i)
    if (single.colour.pixels[4 * i + 3] > 0.999f && grey.colour.pixels[4 * i + 3] > 0.999f) {
      apart += std::abs(static_cast<double>(grey.depth.pixels[i]) - single.depth.pixels[i]);
      ++opaque;
    }
  REQUIRE(opaque > 100);
  CHECK(apart > 0);
  CHECK(apart / opaque < 0.5 * scene.sampling.spacing);
  // Where there is nothing there is no depth.
  scene.clipPlanes = {{0, 0, 1, -1000}};
  const Picture empty = progressiveSlices(*context, *volume, scene, {.passes = 4}, kLayers).picture;
  for (const float depth : empty.depth.pixels) CHECK(depth == std::numeric_limits<float>::infinity());
  for (const float alpha : empty.colour.pixels) CHECK(alpha == 0);
}

TEST_CASE("The same seed gives the same picture to the bit, another seed another one", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  const ResolvedScene scene = smallScene();
  const auto volume = bricksForPasses(grid, scene);
  const auto picture = [&](std::uint64_t seed) {
    return progressiveSlices(*context, *volume, scene, {.passes = 5, .seed = seed}, kLayers);
  };
  const ProgressivePicture a = picture(3), b = picture(3), c = picture(4);
  CHECK((a.picture.colour.pixels == b.picture.colour.pixels));
  CHECK((a.picture.visibility.pixels == b.picture.visibility.pixels));
  CHECK((a.picture.depth.pixels == b.picture.depth.pixels));
  CHECK(a.error.statistical == b.error.statistical);
  CHECK(a.error.systematic == b.error.systematic);
  CHECK(rmsOfRgb(a.picture.colour, c.picture.colour) > 0.1 * a.error.statistical);
}

// Four streams leave 3 degrees of freedom to a pixel, and pixels share directions: a picture's estimate has perhaps
// ten, and is off by a quarter in one of three pictures, hardly ever by a factor of two. Over 12 pictures it is known
// to a third of that; measured: 0.92 to 0.97 of the error that is found. The error falls with the power 0.7 of the
// number of samples.
TEST_CASE("The standard error is that of the samples' mean, which falls faster than with the root of their number",
          "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  const ResolvedScene scene = smallScene();
  const auto volume = bricksForPasses(grid, scene);
  const Image limit = progressiveSlices(*context, *volume, scene, {.passes = 256, .seed = 99}).picture.colour;
  std::vector<double> passes{4, 8, 16}, distances;
  std::vector<std::vector<double>> estimated(3), apart(3);
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    progressiveSlices(*context, *volume, scene, {.passes = 16, .seed = seed}, {},
                      [&](const ProgressivePicture& picture) {
                        for (std::size_t n = 0; n < 3; ++n)
                          if (picture.passes == passes[n]) {
                            estimated[n].push_back(picture.error.statistical);
                            apart[n].push_back(rmsOfRgb(picture.picture.colour, limit));
                          }
                        return true;
                      });
  for (std::size_t n = 0; n < 3; ++n) {
    distances.push_back(rootMeanSquare(apart[n]));
    INFO(passes[n] << " passes: estimated " << rootMeanSquare(estimated[n]) << ", found " << distances[n]);
    CHECK(rootMeanSquare(estimated[n]) == Approx(distances[n]).epsilon(0.25));
    for (std::size_t i = 0; i < apart[n].size(); ++i) {
      INFO("seed " << i + 1 << ": estimated " << estimated[n][i] << ", found " << apart[n][i]);
      CHECK(apart[n][i] < 2 * estimated[n][i]);
      CHECK(apart[n][i] > 0.5 * estimated[n][i]);
    }
  }
  const double order = observedOrder(passes, distances);
  INFO("order " << order);
  CHECK(order < -0.5);
}

// Returns the courtyard of a quality in so many pixels: walls of 4 voxels, a shell of 3, edges of one.
ResolvedScene qualityScene(Quality quality, int pixels) {
  Scene scene = unresolved(smallScene());
  scene.camera.width = scene.camera.height = pixels;
  applyQuality(quality, scene);
  // Estimates of the systematic error are of ordinates: of a light volume it is not known what voxels do to light.
  scene.method = Method::ordinates;
  return resolvedAnywhere(scene);  // a voxel is a world unit
}

// Pixels have a width of 1.8 and 0.9 voxels. When texels followed pixels, `high` had slabs of 1.25 voxels and texels of
// 1.8 in the smaller picture, and an estimate that was too low.
TEST_CASE("Better quality is nearer to the reference at any size and estimates how near, within a factor of two",
          "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  ReferenceOptions options;
  options.tolerance = 2e-3;
  options.directions = 128;
  for (const int pixels : {24, 48}) {
    const Image exact = renderReference(grid, qualityScene(Quality::high, pixels), options).colour;
    double coarser = kInfinity, coarserMean = kInfinity;
    for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
      const ResolvedScene scene = qualityScene(quality, pixels);
      const auto volume = bricksForPasses(grid, scene);
      const double single = rmsOfRgb(renderPicture(*context, *volume, scene).colour, exact);
      const ProgressivePicture passes = progressiveSlices(*context, *volume, scene, {.passes = 8});
      const double mean = rmsOfRgb(passes.picture.colour, exact);
      INFO(pixels << " pixels, quality " << static_cast<int>(quality) << ": one picture " << single << ", mean of 8 "
                  << mean << ", estimated " << passes.error.statistical << " and " << passes.error.systematic << ", "
                  << passes.error.total());
      CHECK(passes.error.total() == Approx(std::hypot(passes.error.statistical, passes.error.systematic)));
      CHECK(single < coarser);
      CHECK(mean < coarserMean);
      CHECK(mean < 2 * passes.error.total());
      CHECK(mean > 0.5 * passes.error.total());
      coarser = single;
      coarserMean = mean;
    }
  }
}

TEST_CASE("Samples end where the target is reached, at the time limit, or when told", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  const ResolvedScene scene = smallScene(64);
  const auto volume = bricksForPasses(grid, scene);
  const ProgressivePicture four = progressiveSlices(*context, *volume, scene, {.passes = 4});
  // The target lies between the error after four samples and the error that no number of samples gets below.
  const double target = std::hypot(four.error.systematic, 0.6 * four.error.statistical);
  const ProgressivePicture reached =
      progressiveSlices(*context, *volume, scene, {.passes = 200, .targetError = target});
  CHECK(reached.reachedTarget);
  CHECK(reached.error.total() <= target);
  CHECK(reached.passes > 4);
  CHECK(reached.passes < 40);
  CHECK(reached.scene == scene);
  // The picture is the same as if so many samples had been asked for.
  const ProgressivePicture asked = progressiveSlices(*context, *volume, scene, {.passes = reached.passes});
  CHECK((asked.picture.colour.pixels == reached.picture.colour.pixels));
  CHECK_FALSE(asked.reachedTarget);
  const ProgressivePicture missed =
      progressiveSlices(*context, *volume, scene, {.passes = 10, .targetError = 0.5 * four.error.systematic});
  CHECK_FALSE(missed.reachedTarget);
  CHECK(missed.passes == 10);
  CHECK(missed.scene == scene);  // nobody has allowed the scene to be refined

  CHECK(progressiveSlices(*context, *volume, scene, {.passes = 100, .maxSeconds = 1e-9}).passes == 1);
  int calls = 0;
  const ProgressivePicture told = progressiveSlices(*context, *volume, scene, {.passes = 100}, {},
                                                    [&](const ProgressivePicture&) { return ++calls < 3; });
  CHECK(calls == 3);
  CHECK(told.passes == 3);
  CHECK(told.error.statistical == kInfinity);
}

TEST_CASE("Slabs and texels are halved where they are in the way of the target", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  const ResolvedScene scene = smallScene(10, 16);
  const auto volume = bricksForPasses(grid, scene);
  const ProgressivePicture coarse = progressiveSlices(*context, *volume, scene, {.passes = 4, .pixelArea = false});
  ProgressiveOptions options{
      .passes = 60, .targetError = 0.75 * coarse.error.systematic, .refine = true, .pixelArea = false};
  std::vector<double> spacings;
  const ProgressivePicture fine =
      progressiveSlices(*context, *volume, scene, options, {}, [&](const ProgressivePicture& picture) {
        if (spacings.empty() || picture.scene.sampling.spacing < spacings.back()) {
          // Finer slabs take over once they are known to be better.
          CHECK(picture.passes >= (spacings.empty() ? 1 : kStreams));
          CHECK(std::isfinite(picture.error.total()) == !spacings.empty());
          spacings.push_back(picture.scene.sampling.spacing);
        }
        return true;
      });
  INFO("coarse " << coarse.error.statistical << ' ' << coarse.error.systematic << ", fine " << fine.error.statistical
                 << ' ' << fine.error.systematic << ' ' << fine.passes);
  REQUIRE(spacings.size() >= 2);
  for (std::size_t i = 0; i < spacings.size(); ++i)
    CHECK(spacings[i] == Approx(scene.sampling.spacing / std::pow(2, i)));
  CHECK(fine.reachedTarget);
  CHECK(fine.error.total() <= options.targetError);
  CHECK(fine.scene.sampling.spacing == spacings.back());
  // The picture is one of the scene that it says. Its bricks were resident already, at other places of the texture,
  // whose coordinates are single precision.
  const ProgressivePicture again =
      progressiveSlices(*context, *volume, fine.scene, {.passes = fine.passes, .pixelArea = false});
  CHECK(maxDifference(again.picture.colour, fine.picture.colour) < 2e-5);
  CHECK(again.error.systematic < coarse.error.systematic);

  // A scene is not refined at the expense of the present one: when the samples that are left would not tell the error
  // of finer slabs.
  for (const int passes : {4, 5, 7}) {
    options.passes = passes;
    const ProgressivePicture last = progressiveSlices(*context, *volume, scene, options);
    INFO("of " << passes << " passes");
    CHECK(last.passes == passes);
    CHECK(last.scene == scene);
    CHECK(std::isfinite(last.error.total()));
  }
  // Slabs get no finer than an eighth of a voxel.
  options.passes = 9;
  options.targetError = 1e-9;
  ResolvedScene finest = scene;
  finest.clipPlanes = {{0, 0, -1, 3}};  // leaves fewer slices
  finest.sampling.spacing = 0.125;
  CHECK(progressiveSlices(*context, *volume, finest, options).scene == finest);
}

TEST_CASE("Without bricks for thicker slabs, thinner ones tell the systematic error", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  const ResolvedScene scene = smallScene();  // slabs of 3.25 voxels
  const auto narrow = bricksFor(grid, scene), wide = bricksForPasses(grid, scene);
  REQUIRE(narrow->layout.apron < wide->layout.apron);
  const ProgressivePicture picture = progressiveSlices(*context, *narrow, scene, {.passes = 8});
  const ProgressivePicture other = progressiveSlices(*context, *wide, scene, {.passes = 8});
  ReferenceOptions options;
  options.tolerance = 2e-3;
  options.directions = 128;
  const double found = rmsOfRgb(picture.picture.colour, renderReference(grid, scene, options).colour);
  INFO("thinner " << picture.error.systematic << ", thicker " << other.error.systematic << ", statistical "
                  << picture.error.statistical << ", found " << found);
  CHECK(found < 2 * picture.error.total());
  CHECK(found > 0.5 * picture.error.total());
  // Texture coordinates in other bricks are rounded differently, by up to 3e-6 voxels. The optical depth of a slab,
  // 3.25 of sigma_t 3, changes by up to 16 per voxel: 5e-5, in each of the one or two slabs that make a pixel opaque.
  CHECK(maxDifference(other.picture.colour, picture.picture.colour) < 1e-4);
}

// Only slices and texels are left to average over: the light itself is the same in every sample.
TEST_CASE("Listed directions come whole in every sample", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ResolvedScene layer = layerScene(false);
  const FieldBricks volume = layerVolume(coarserScene(layer));
  const ProgressivePicture passes = progressiveSlices(*context, volume, layer, {.passes = 8});
  // As the test of samples says, all samples are one picture, to which slabs twice as thick make no difference.
  const double slabs = 16 / layer.sampling.spacing + 2;
  const double tolerance = 2 * (slabs * 10 * kFloatRounding + 4e-6 * 0.11 * 2 * layer.sampling.spacing);
  CHECK(maxDifference(passes.picture.colour, renderPicture(*context, volume, layer).colour) < tolerance);
  CHECK(passes.error.statistical < tolerance);
  CHECK(passes.error.systematic < tolerance);

  const ScalarGrid grid = courtyard();
  ResolvedScene scene = smallScene(64);
  scene.model = Model::lights;
  scene.lights = {
      {LightFrame::view, ListedLight{{{{0.5, 0.2, 0.8}, 0.5, {1, 0.5, 0}}, {{0, 0, 1}, 0.5, {0, 0.5, 1}}}}}};
  const auto bricks = bricksForPasses(grid, scene);
  ReferenceOptions options;
  options.tolerance = 1e-3;
  const Image exact = renderReference(grid, scene, options).colour;
  const ProgressivePicture lit = progressiveSlices(*context, *bricks, scene, {.passes = 16});
  const double mean = rmsOfRgb(lit.picture.colour, exact);
  INFO("estimated " << lit.error.statistical << " and " << lit.error.systematic << ", found " << mean);
  // Texels are as wide as a pixel, 1.8 voxels, and twice as wide as slabs are thick: their blur is in the
  // estimate, too. At hard edges the order is between 1/2 and 1, and the difference to slabs twice as large is
  // 0.41 to 1 of the error.
  CHECK(mean < 2.4 * lit.error.total());
  CHECK(mean > 0.5 * lit.error.total());
}

TEST_CASE("Options of samples that make no sense are refused", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = courtyard();
  const ResolvedScene scene = smallScene();
  const auto volume = bricksForPasses(grid, scene);
  const auto refused = [&](const ResolvedScene& changed, const ProgressiveOptions& options) {
    return complaint<InvalidArgument>([&] { progressiveSlices(*context, *volume, changed, options); });
  };
  ResolvedScene dos = scene;
  dos.method = Method::dos;
  CHECK(refused(dos, {}) ==
        "progressive: needs the model emission, or cone, ambient or lights and the method ordinates or light-volume, "
        "found cone and dos");
  CHECK(refused(scene, {.passes = 0}) == "progressive: passes is 0, must be 1 or more");
  CHECK(refused(scene, {.passes = -3}) == "progressive: passes is -3, must be 1 or more");
  using Catch::Contains;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan}) {
    CHECK_THAT(refused(scene, {.maxSeconds = bad}), Contains("seconds") && Contains("must be 0 or more"));
    CHECK_THAT(refused(scene, {.targetError = bad}), Contains("target error") && Contains("must be 0 or more"));
  }
}
