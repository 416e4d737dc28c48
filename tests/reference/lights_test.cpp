// Any directions of light: laws and closed forms, by both integrators.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/lights.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "reference/visibility_fixture.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

LightSource cone(LightFrame frame, const glm::dvec3& axis, double degrees, const glm::dvec3& radiance = kWhite) {
  return {frame, ConeLight{axis, degrees * std::numbers::pi / 180, radiance}};
}

// Returns a scene in which the model has everything to look at: a dense field, and a view that no axis is aligned with.
ResolvedScene denseScene(const std::vector<LightSource>& lights) {
  const TransferFunction transfer({{0.05, {{0.9, 0.3, 0.1}, 0}}, {0.8, {{1, 0.9, 0.8}, 1}}});
  ResolvedScene scene = plainScene(transfer, perspectiveCamera({39, -8, 33}, {14, 14, 14}, 0.9, 8), 1);
  scene.model = Model::lights;
  scene.lights = lights;
  return scene;
}
ScalarGrid denseGrid() { return makeDense(glm::ivec3(28)); }

double largest(const Image& image) {
  double most = 0;
  for (const float value : image.pixels) most = std::max<double>(most, std::abs(value));
  return most;
}

// Steps have a given length, so that stretches do not depend on the light.
ReferenceOptions steps(int directions) {
  ReferenceOptions options;
  options.directions = directions;
  options.step = 1;
  return options;
}

}  // namespace

TEST_CASE("A cone of light around the view axis is the model cone", "[reference]") {
  ResolvedScene scene = denseScene({cone(LightFrame::view, {0, 0, 1}, 50)});
  ResolvedScene same = scene;
  same.model = Model::cone;
  same.occlusion.aperture = 50 * std::numbers::pi / 180;
  for (const ReferenceOptions& options : {quadrature(24), monteCarlo(50)}) {
    const ReferencePicture a = renderReference(denseGrid(), scene, options);
    const ReferencePicture b = renderReference(denseGrid(), same, options);
    CHECK(largest(a.colour) > 0.1);
    CHECK(maxDifference(a.colour, b.colour) == 0);
    CHECK(maxDifference(a.visibility, b.visibility) == 0);
    CHECK(maxDifference(a.standardError, b.standardError) == 0);
  }
}

// Light adds up. This is exact where each source has the same directions by itself as together with others.
TEST_CASE("The picture of several lights is the sum of theirs", "[reference]") {
  const std::vector<LightSource> lights{
      cone(LightFrame::view, {1, 0, 1}, 0, {2, 0.1, 0.4}),
      cone(LightFrame::world, {1, -1, 1}, 0, {0.1, 0.7, 0.4}),
      {LightFrame::view, ListedLight{{{{0, 1, 2}, 0.5, {1, 0, 1}}, {{0, -1, 3}, 2, {0.2, 0.2, 0.3}}}}}};
  const ReferencePicture together = renderReference(denseGrid(), denseScene(lights), steps(8));
  Image sum(8, 8), visibility(8, 8, 1);
  double power = 0;
  for (const LightSource& light : lights) {
    const ResolvedScene scene = denseScene({light});
    double own = 0;
    for (const LightDirection& d : lightDirections(scene, 1)) own += (d.radiance.r + d.radiance.g + d.radiance.b) / 3;
    const ReferencePicture alone = renderReference(denseGrid(), scene, steps(8));
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += alone.colour.pixels[i];
    for (std::size_t i = 0; i < visibility.pixels.size(); ++i)
      visibility.pixels[i] += static_cast<float>(own * alone.visibility.pixels[i]);
    power += own;
  }
  for (float& value : visibility.pixels) value /= static_cast<float>(power);
  for (std::size_t i = 3; i < sum.pixels.size(); i += 4) sum.pixels[i] /= 3;  // the opacity is that of each picture
  // The limit is for four pictures in single precision, with radiances up to 4.
  CHECK(largest(together.colour) > 1);
  CHECK(maxDifference(together.colour, sum) < 4 * 4 * kFloatRounding);
  CHECK(maxDifference(together.visibility, visibility) < 4 * 2 * kFloatRounding);
}

// Of 600 directions of soft lights, a pixel's share is off by about 1/600 of what edges of shadows move it by. Lights
// together and alone have different numbers and places of directions.
TEST_CASE("Soft lights add up as far as their directions reach", "[reference][slow]") {
  const LightSource a = cone(LightFrame::view, {1, 0, 1}, 40, {1, 0.1, 0.4}),
                    b = cone(LightFrame::world, {1, -1, 1}, 25, {0.1, 0.7, 0.4});
  const ReferencePicture both = renderReference(denseGrid(), denseScene({a, b}), steps(1200));
  const ReferencePicture one = renderReference(denseGrid(), denseScene({a}), steps(600));
  const ReferencePicture other = renderReference(denseGrid(), denseScene({b}), steps(600));
  for (std::size_t i = 0; i < both.colour.pixels.size(); ++i)
    if (i % 4 != 3) CHECK(std::abs(both.colour.pixels[i] - one.colour.pixels[i] - other.colour.pixels[i]) < 1e-3);
}

// Sigma is the extinction of a slab, and c the cosine of the angle by which the light is tilted. At depth t the light
// has passed exp(-sigma t / c), and what it scatters loses exp(-sigma t) more on its way to the eye. So a slab of
// thickness L gives (1 - exp(-sigma L (1 + 1/c))) / (1 + 1/c), and what lies behind it is dimmed on both ways.
TEST_CASE("A sharp tilted light passes two slabs by their thickness over the cosine", "[reference]") {
  const TwoSlabs slabs;
  const ScalarGrid grid = fieldGrid({glm::ivec3(0), glm::ivec3(40, 24, 24)}, [](const glm::dvec3& p) { return p.z; });
  ResolvedScene scene = plainScene(slabs.transfer, orthographicCamera({12, 12, 60}, {12, 12, 12}, 1, 2), 1);
  scene.camera.up = {0, 1, 0};
  scene.clipBox = Box{glm::dvec3(1), glm::dvec3(39, 23, 23)};
  scene.model = Model::lights;
  const glm::dvec3 radiance(2, 0.5, 1);
  for (const double degrees : {0.0, 30.0, 60.0}) {
    const double angle = degrees * std::numbers::pi / 180, stretch = 1 + 1 / std::cos(angle);
    // The light is given in the world and in the view. As the camera looks along -z with y up, the
    // direction is the same.
    for (const LightFrame frame : {LightFrame::world, LightFrame::view}) {
      scene.lights = {cone(frame, {std::sin(angle), 0, std::cos(angle)}, 0, radiance)};
      const glm::dvec3 expected = slabs.light(stretch, true) / stretch * radiance;
      INFO(degrees << " degrees: " << expected.x);
      const ReferencePicture smooth = renderReference(grid, scene, quadrature(1));
      for (int c = 0; c < 3; ++c)
        // There are two slabs of a few stretches each, and each stretch is off by 1e-5 of the light.
        CHECK(std::abs(smooth.colour.at(0, 0)[c] - expected[c]) < 1e-4 * 2);
      const ReferencePicture random = renderReference(grid, scene, monteCarlo(40'000));
      for (int c = 0; c < 3; ++c)
        CHECK(std::abs(random.colour.at(1, 1)[c] - expected[c]) < 4 * random.standardError.at(1, 1)[c]);
    }
  }
}

// This is as in the test of the cone's half-plane. Beyond the roof's edge lies a part of a cone that is
// tilted towards it.
TEST_CASE("An opaque half-plane hides its share of a tilted cone", "[reference][slow]") {
  const ScalarGrid grid = floorAndRoof();
  const double a = 9, edge = std::atan(a / 11);
  for (const double tilt : {-40.0, 20.0, 38.0})
    for (const double theta : {0.0, 10.0, 45.0}) {
      ResolvedScene scene = lookingDownAt(floorAndRoofTransfer(), Model::lights, 12 - a, 0);
      const double radians = tilt * std::numbers::pi / 180, aperture = theta * std::numbers::pi / 180;
      scene.lights = {cone(LightFrame::world, {std::sin(radians), 0, std::cos(radians)}, theta, {1, 0.5, 0.25})};
      const double expected = 1 - shareBeyond(aperture, edge - radians);
      INFO("tilt " << tilt << ", theta " << theta << ": " << expected);
      const ReferencePicture picture = renderReference(grid, scene, quadrature(4000));
      // The first term is as in that test, and the second the floor's own depth along a path of 85 degrees at most.
      CHECK(std::abs(meanVisibility(picture) - expected) < 0.5 / std::sqrt(4000.0) + 0.0015);
      const float* pixel = picture.colour.at(0, 0);
      CHECK(pixel[1] == Approx(0.5 * pixel[0]).epsilon(1e-6));
      CHECK(pixel[2] == Approx(0.25 * pixel[0]).epsilon(1e-6));
    }
}

// The closed form of the cone in a half-space, as its angle goes to 90 degrees, is 1 - ln 2 of the light of half a
// sphere. An isotropic phase function scatters half of it.
TEST_CASE("A constant environment lights a half-space as half of the sphere does", "[reference]") {
  const ScalarGrid grid = makeVoxels({{glm::ivec3(-4000, -4000, -39), 1}, {glm::ivec3(4000, 4000, -1), 1}}, 1);
  ResolvedScene scene = lookingDownAt(homogeneous({0.8, 0.5, 0.3}, 0.7), Model::lights, 0, 0);
  const glm::dvec3 radiance(1, 3, 2);
  scene.lights = {environmentOf(7, 3, radiance, false)};
  const glm::dvec3 expected = (1 - std::log(2.0)) / 2 * glm::dvec3(0.8, 0.5, 0.3) * radiance;
  // Parts of the hemisphere stand for the direction of their centre. 1000 parts are a 25th of it across, and light that
  // grazes the surface is of little use, so the error is half of a 1000th.
  const ReferencePicture smooth = renderReference(grid, scene, quadrature(1000));
  const ReferencePicture random = renderReference(grid, scene, monteCarlo(200'000));
  for (int c = 0; c < 3; ++c) {
    CHECK(smooth.colour.at(0, 0)[c] == Approx(expected[c]).epsilon(2e-3));
    CHECK(std::abs(random.colour.at(0, 0)[c] - expected[c]) < 4 * random.standardError.at(0, 0)[c]);
  }
  // Beyond 89.9 degrees there is a 570th of the hemisphere, all of it grazing.
  scene.lights = {cone(LightFrame::view, {0, 0, 1}, 89.9, 0.5 * radiance)};
  const ReferencePicture wide = renderReference(grid, scene, quadrature(1000));
  for (int c = 0; c < 3; ++c)
    CHECK(smooth.colour.at(0, 0)[c] == Approx(wide.colour.at(0, 0)[c]).epsilon(1.0 / 570 + 2e-3));
}

TEST_CASE("Each light has its own colour in its own shadow", "[reference]") {
  const ScalarGrid grid = floorAndRoof();
  ResolvedScene scene = lookingDownAt(floorAndRoofTransfer(), Model::lights, 3, 0);
  // The roof is to the right, with its edge at 39 degrees: red light is open, blue light is not.
  scene.lights = {cone(LightFrame::view, {-1, 0, 1}, 0, {3, 0, 0}), cone(LightFrame::view, {1, 0, 1}, 0, {0, 0, 1})};
  for (const ReferenceOptions& options : {quadrature(2), monteCarlo(400'000)}) {
    const ReferencePicture picture = renderReference(grid, scene, options);
    const float* pixel = picture.colour.at(0, 0);
    const double red = pixel[0] / pixel[3], seen = meanVisibility(picture);
    CHECK(pixel[2] == 0);
    if (options.integrator == Integrator::quadrature) {
      CHECK(red == Approx(3).epsilon(2 * kFloorDepth));
      CHECK(seen == Approx(0.75).epsilon(2 * kFloorDepth));
    } else {
      // Some 40 of 400 000 paths meet the floor, each of them red or blue. That says little more than the ratio.
      REQUIRE(pixel[3] > 0);
      CHECK(red == Approx(4 * seen).epsilon(1e-5));
    }
  }
}

TEST_CASE("What lies behind the eye does not shade lights", "[reference]") {
  ResolvedScene scene = denseScene({cone(LightFrame::view, {1, 0, 1}, 30), cone(LightFrame::view, {0, 1, 3}, 0)});
  scene.camera = perspectiveCamera({15, 13, 14}, {14, 14, 3}, 1.2, 6);
  scene.model = Model::lights;
  const ReferencePicture whole = renderReference(denseGrid(), scene, steps(20));
  const glm::dvec3 forward = cameraFrame(scene.camera).forward;
  scene.clipPlanes = {ClipPlane(forward, -glm::dot(forward, scene.camera.eye))};
  const ReferencePicture cut = renderReference(denseGrid(), scene, steps(20));
  CHECK(largest(whole.colour) > 0.1);
  CHECK(maxDifference(whole.colour, cut.colour) < 1e-6);  // rays are clipped twice, each time to rounding
}

TEST_CASE("A given list of directions takes the place of the light's own", "[reference]") {
  for (const Model model : {Model::cone, Model::lights}) {
    ResolvedScene scene = denseScene({cone(LightFrame::view, {1, 0, 1}, 40, {1, 0.1, 0.4})});
    scene.model = model;
    ReferenceOptions options = steps(12);
    const ReferencePicture own = renderReference(denseGrid(), scene, options);
    options.lights = lightDirections(scene, 12);
    options.directions = 77;
    const ReferencePicture given = renderReference(denseGrid(), scene, options);
    CHECK(maxDifference(own.colour, given.colour) == 0);
    CHECK(maxDifference(own.visibility, given.visibility) == 0);
    // The mean of the pictures of two sets is the picture of their union.
    const auto first = lightSamples(scene, 0, 6, 1), second = lightSamples(scene, 6, 6, 1);
    options.lights = first;
    const ReferencePicture a = renderReference(denseGrid(), scene, options);
    options.lights = second;
    const ReferencePicture b = renderReference(denseGrid(), scene, options);
    options.lights.clear();
    for (const auto& set : {first, second})
      for (const auto& [direction, radiance] : set) options.lights.push_back({direction, 0.5 * radiance});
    const ReferencePicture both = renderReference(denseGrid(), scene, options);
    Image mean(8, 8);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
      mean.pixels[i] = 0.5f * (a.colour.pixels[i] + b.colour.pixels[i]);
    CHECK(maxDifference(both.colour, mean) < 4 * kFloatRounding);
    // Paths choose among the directions by power. The limit is four standard errors: of 16 000 pixels one is off by
    // more, and there are 192.
    ReferenceOptions paths = monteCarlo(4000);
    paths.lights = options.lights;
    const ReferencePicture random = renderReference(denseGrid(), scene, paths);
    const ReferencePicture exact = [&] {
      ReferenceOptions fine = quadrature(1);
      fine.lights = options.lights;
      return renderReference(denseGrid(), scene, fine);
    }();
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
      CHECK(std::abs(random.colour.pixels[i] - exact.colour.pixels[i]) <
            4.5 * random.standardError.pixels[i] + 12.0 / 4000);
  }
}

TEST_CASE("Lights that are switched off give black, with nothing undefined", "[reference]") {
  for (const ReferenceOptions& options : {quadrature(4), monteCarlo(20)}) {
    const ReferencePicture picture =
        renderReference(denseGrid(), denseScene({cone(LightFrame::view, {0, 0, 1}, 30, glm::dvec3(0))}), options);
    for (std::size_t i = 0; i < picture.colour.pixels.size(); ++i)
      if (i % 4 != 3) CHECK(picture.colour.pixels[i] == 0);
    CHECK(largest(picture.visibility) == 0);
    CHECK(largest(picture.colour) > 0.1);  // the largest is the opacity
  }
}

TEST_CASE("The reference refuses lights that it cannot take", "[reference]") {
  ResolvedScene scene = denseScene({cone(LightFrame::world, {-25, 22, -19}, 5)});
  const auto refused = [&](const ReferenceOptions& options) {
    return complaint<InvalidArgument>([&] { renderReference(denseGrid(), scene, options); });
  };
  CHECK_THAT(refused({}),
             Catch::Contains("light.sources[0]: its axis is 180 degrees from the direction to the viewer"));
  scene.lights.clear();
  CHECK_THAT(refused({}), Catch::Contains("light.sources: is empty"));
  scene.model = Model::cone;
  ReferenceOptions options;
  options.lights = {{{0, 0, 2}, glm::dvec3(1)}};
  CHECK(refused(options) == "lights: a direction has length 2.000000, must be 1");
  options.lights = {{{0, 0, 1}, {1, -1, 1}}};
  CHECK_THAT(refused(options), Catch::Contains("a radiance is [1.000000, -1.000000, 1.000000], must be three finite"));
  scene.model = Model::coneRay;
  options.lights = {{{0, 0, 1}, glm::dvec3(1)}};
  CHECK(refused(options) == "lights: are given, but the model cone-ray does not take a list");
}
