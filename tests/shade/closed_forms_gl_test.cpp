// Compares the renderer with closed forms that the reference is compared with as well.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <numbers>

#include "shade/footprint.h"
#include "shade/grid_picture.h"
#include "support/closed_forms.h"

using namespace umbrick;

namespace {
const IndexBox kDomain{glm::ivec3(0), glm::ivec3(24)};
}  // namespace

// The surface is where the interpolated square of the distance passes R^2: within 3/8 of a squared voxel. A ramp over
// 20 squared voxels stands for the step; a table of 1024 bins over 1100 squared voxels is exact to 1.1 of them. Slabs
// in which the ramp bends are off by the bend of the squared distance, d^2 / 4.
TEST_CASE("A homogeneous sphere drawn by slices has the opacity of its chords", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const double radius = 10, sigma_t = 0.09, d = 0.25;
  const glm::dvec3 centre(12.3, 11.9, 12.1);
  const ScalarGrid grid = fieldGrid(
      kDomain, [&](const glm::dvec3& p) { return radius * radius - glm::dot(p - centre, p - centre) + 0.375; },
      glm::dmat4(1), -1000);
  const TransferFunction transfer({{-10, {kAlbedo, 0}}, {10, {kAlbedo, sigma_t}}});
  for (const Camera& camera :
       {orthographicCamera(centre + glm::dvec3(30, -20, 25), centre, 24, 24),
        perspectiveCamera(centre + glm::dvec3(-30, 25, 35), centre, 0.5, 24),
        perspectiveCamera(centre + glm::dvec3(2, -1, 3), centre + glm::dvec3(9, 5, 1), 1.4, 24)}) {
    ResolvedScene scene = plainScene(transfer, camera, d);
    const Picture picture = renderGrid(*context, grid, scene);
    double worst = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        const glm::dvec3 w = ray.direction / ray.stretch(), to = centre - ray.origin;
        const double along = glm::dot(to, w), across = glm::dot(to, to) - along * along;
        // The optical depth over the soft sphere is the mean over the ramp of those of sharp ones.
        const auto tau = [&](double shift) {
          return integral(
              -10, 10,
              [&](double ramp) {
                const double reach = std::sqrt(std::max(0.0, radius * radius + shift + ramp - across));
                return sigma_t * (std::max(0.0, along + reach) - std::max(0.0, along - reach)) / 20;
              },
              200);
        };
        const double shift = 0.375 + 1.1 + d * d / 4 + 0.05;  // 0.05: Gauss nodes at the kink of the square root
        const double alpha = picture.colour.at(x, y)[3];
        worst = std::max({worst, -std::expm1(-tau(-shift)) - alpha, alpha + std::expm1(-tau(shift))});
      }
    CHECK(worst < 1e-5);
  }
}

// Steps of the transfer function on a linear field are planes. The table places each step with an error of one bin,
// here 24 units of 1023, and a table's integral is linear where it should bend.
TEST_CASE("Two slabs blend in order with slices of any spacing", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const TwoSlabs slabs;
  const ScalarGrid grid = fieldGrid(kDomain, [](const glm::dvec3& p) { return p.z; });
  for (const bool above : {false, true})
    for (const double d : {0.3, 1.0, 2.6}) {
      ResolvedScene scene =
          plainScene(slabs.transfer, orthographicCamera({12, 9, above ? 60 : -50}, {12, 12, 12}, 8, 16), d);
      scene.clipBox = Box{glm::dvec3(1), glm::dvec3(23)};
      const Picture picture = renderGrid(*context, grid, scene);
      const double stretch = 1 / std::abs(cameraFrame(scene.camera).forward.z);
      const double bins = 24.0 / 1023 * 4 * 0.4 * stretch;  // four edges, each displaced by a bin at most
      INFO("above " << above << ", spacing " << d);
      for (int c = 0; c < 3; ++c) {
        const double expected = slabs.light(stretch, above)[c];
        for (const int pixel : {0, 7, 15}) CHECK(std::abs(picture.colour.at(pixel, pixel)[c] - expected) < bins + 1e-5);
      }
      CHECK(std::abs(1 - picture.colour.at(3, 3)[3] - slabs.transmittance(stretch)) < bins + 1e-5);
    }
}

// Below an opaque half-plane whose edge is the distance `a` aside, the cone has the share of a sphere's cap that a
// great circle cuts off (see the tests of the reference). The repeated mean of dos is a random walk instead: after m
// slices its spread is normal with m times the variance of a step, and V = Phi(a / deviation). Both are closed forms;
// the renderer must have the second one, and how far that is from the first is the method's error.
TEST_CASE("Below an opaque half-plane dos has the light of a random walk, not of the cone", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  // The roof is in layer z = 24 from x = 1 on, the floor in layer z = 4. Slabs are sampled at their middles, one of
  // them exactly in the roof's layer, and only 0.9 or more of the roof's value counts as roof: so it is one slab thick,
  // and begins between the pixels at 0.75 and 1.25.
  const auto field = [](const glm::ivec3& i) { return i.z == 24 && i.x >= 1 ? 1.0 : i.z == 4 ? -1.0 : 0.0; };
  const TransferFunction transfer(
      {{-1, {glm::dvec3(1), 1e-3}}, {0, {glm::dvec3(1), 0}}, {0.9, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), 1e4}}});
  const double d = 0.5, theta = 60 * std::numbers::pi / 180, edge = 1;
  const int size = 80, roof = 32, floor = 72;  // slabs
  ResolvedScene scene = plainScene(transfer, orthographicCamera({0, 0, 40.25}, {0, 0, 0}, 40, size), d);
  scene.camera.up = {0, 1, 0};
  scene.model = Model::cone;
  scene.sampling.quadrature = Quadrature::midpoint;
  scene.occlusion.aperture = theta;
  for (const int footprint : {2, 3, 5}) {
    scene.occlusion.dos.footprint = footprint;
    const FieldBricks volume = fieldFor(scene, field, {glm::ivec3(-32), glm::ivec3(31)});
    const Picture picture = renderPicture(*context, volume, scene, {.visibilityAndDepth = true});
    const double pixel = 40.0 / size, radius = d * std::tan(theta) / pixel;
    double variance = 0;  // variance of a step along x, squared pixels
    for (const glm::dvec2& point : diskGrid(footprint)) {
      const double offset = radius * point.x, f = offset - std::floor(offset);
      variance += (offset * offset + f * (1 - f)) / (footprint * footprint);
    }
    // The floor is seen in the slabs where its value, a tent along z, is half, full and half again. Each of them reads
    // the slice before it, to which light came from the roof's slice in so many steps.
    const auto expected = [&](double a) {
      double sum = 0;
      for (const int slab : {floor - 1, floor, floor, floor + 1}) {
        const double deviation = std::sqrt((slab - 1 - roof) * variance) * pixel;
        sum += 0.25 * 0.5 * std::erfc(-a / deviation / std::sqrt(2.0));
      }
      return sum;
    };
    for (const int x : {41, 38, 34, 28, 22}) {
      const double a = edge - ((x + 0.5) * pixel - 20);
      const double seen = *picture.visibility.at(x, size / 2) / picture.colour.at(x, size / 2)[3];
      INFO("n " << footprint << ", " << a << " from the edge: walk " << expected(a) << ", cone "
                << 1 - shareBeyond(theta, std::atan(a / 20)));
      // After m = 39 steps with an excess kurtosis of -1 to 1 a normal distribution is off by 0.55 / 24 / m = 6e-4. The
      // floor hides 1e-3 of itself. The roof is known to half a pixel, on each side alike, which is a second-order
      // change of 1e-3.
      CHECK(std::abs(seen - expected(a)) < 0.003);
      // The light that the cone lets in is far from this, both where light enters and where it is still dark.
      if (a > 3) CHECK(seen - (1 - shareBeyond(theta, std::atan(a / 20))) > 0.1);
    }
  }
}
