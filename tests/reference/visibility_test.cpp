// The light that reaches a point is compared with closed forms, by both integrators.
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, Eqs. 6-10
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <numbers>

#include "reference/visibility_fixture.h"

using namespace umbrick;

// A path from the floor passes the roof when it meets neither its face at x = 12, which reaches from z = 13 to 15, nor
// what is behind the face. The limit is the plane through the point and the upper edge, which is 11 above the floor's
// layer. At x = 12 - a this plane is at atan(a / 11) from the vertical. The floor has a thickness of its own: its light
// comes from heights spread by 1/sqrt(6) around z = 4. This changes the angle to second order, by less than (0.4 /
// 11)^2 of itself.
TEST_CASE("An opaque half-plane hides its share of the cone", "[reference][slow]") {
  const ScalarGrid grid = floorAndRoof();
  for (const double theta : {20.0, 60.0, 85.0})
    for (const double a : {1.0, 4.0, 9.0}) {
      const double aperture = theta * std::numbers::pi / 180, edge = std::atan(a / 11);
      const ResolvedScene scene = lookingDownAt(floorAndRoofTransfer(), Model::cone, 12 - a, aperture);
      const double expected = 1 - shareBeyond(aperture, edge);
      INFO("theta " << theta << ", " << a << " from the edge: " << expected);
      // A set of K directions is about sqrt(K) of them across, and those on the edge count whole or not at all.
      CHECK(std::abs(meanVisibility(renderReference(grid, scene, quadrature(4000))) - expected) <
            0.5 / std::sqrt(4000.0) + 0.0015);
    }
}

TEST_CASE("An opaque half-plane hides its share of the sphere", "[reference][slow]") {
  const int far = 400;
  const ScalarGrid grid = floorAndRoof(far);
  for (const double a : {1.0, 4.0, 9.0}) {
    const ResolvedScene scene = lookingDownAt(floorAndRoofTransfer(), Model::ambient, 12 - a, 1);
    // The share is that of the upper half. Below the far end of the roof, 10 high, half a belt of the sphere
    // stays open at most.
    const double expected = 1 - 0.5 * shareBeyond(std::numbers::pi / 2, std::atan(a / 11));
    const double open = 0.25 * std::sin(std::atan(10.0 / (far - 12)));
    INFO(a << " from the edge: " << expected << " to " << expected + open);
    const double seen = meanVisibility(renderReference(grid, scene, quadrature(4000)));
    CHECK(seen > expected - 0.5 / std::sqrt(4000.0) - 0.0015);
    CHECK(seen < expected + open + 0.5 / std::sqrt(4000.0) + 0.0015);
  }
}

// The cone is around the view ray, which is tilted by 25 degrees away from the roof, so the edge is 25 degrees farther
// from the axis of the cone.
TEST_CASE("The cone around the view ray tilts with it", "[reference]") {
  const ScalarGrid grid = floorAndRoof();
  const double tilt = 25 * std::numbers::pi / 180, aperture = 60 * std::numbers::pi / 180, a = 4;
  ResolvedScene scene = lookingDownAt(floorAndRoofTransfer(), Model::coneRay, 12 - a, aperture);
  const glm::dvec3 point(12 - a, 0, 4), towardsEye(-std::sin(tilt), 0, std::cos(tilt));
  scene.camera.eye = point + 30.0 * towardsEye;
  scene.camera.lookAt = point;
  for (const Model model : {Model::coneRay, Model::cone}) {
    // In a parallel view the two cones are one.
    scene.model = model;
    const double seen = meanVisibility(renderReference(grid, scene, quadrature(4000)));
    CHECK(std::abs(seen - (1 - shareBeyond(aperture, std::atan(a / 11) + tilt))) < 0.5 / std::sqrt(4000.0) + 0.0015);
  }
  // With an eye straight above and a slanted ray they differ: the cone around the slice normal stays upright.
  const double height = 30;
  scene.camera = perspectiveCamera({point.x - height * std::tan(tilt), 0, 4 + height},
                                   {point.x - height * std::tan(tilt), 0, 0}, 2 * std::atan(2 * std::tan(tilt)), 2);
  scene.camera.up = {0, 1, 0};
  scene.camera.width = 4;
  scene.camera.height = 1;
  // Pixels are at -3, -1, 1 and 3 times a third of tan(tilt).
  scene.camera.fov = 2 * std::atan(std::tan(tilt) / 3);
  const auto rightmost = [&](Model model) {
    scene.model = model;
    const ReferencePicture picture = renderReference(grid, scene, quadrature(4000));
    return double(*picture.visibility.at(3, 0)) / picture.colour.at(3, 0)[3];
  };
  CHECK(std::abs(rightmost(Model::coneRay) - (1 - shareBeyond(aperture, std::atan(a / 11) + tilt))) <
        0.5 / std::sqrt(4000.0) + 0.0015);
  CHECK(std::abs(rightmost(Model::cone) - (1 - shareBeyond(aperture, std::atan(a / 11)))) <
        0.5 / std::sqrt(4000.0) + 0.0015);
}

// Light from direction theta passes exp(-sigma_t t / cos) to depth t of a half-space, and T = exp(-sigma_t t) of what
// it scatters gets out. The integral over t is cos / (1 + cos), whose mean over the cone is elementary.
TEST_CASE("Inside a homogeneous half-space the cone has its closed form", "[reference]") {
  const double sigma_t = 0.7;
  // Two voxels span the domain, and its background is the medium.
  const ScalarGrid grid = makeVoxels({{glm::ivec3(-2000, -2000, -39), 1}, {glm::ivec3(2000, 2000, -1), 1}}, 1);
  for (const double theta : {0.0, 20.0, 60.0, 85.0}) {
    const double aperture = theta * std::numbers::pi / 180, cosine = std::cos(aperture);
    const ResolvedScene scene = lookingDownAt(homogeneous({0.8, 0.5, 0.3}, sigma_t), Model::cone, 0, aperture);
    const double expected = theta > 0 ? 1 - std::log(2 / (1 + cosine)) / (1 - cosine) : 0.5;
    INFO("theta " << theta << ": " << expected);
    const ReferencePicture smooth = renderReference(grid, scene, quadrature(100));
    // An eye ray of optical depth 14 has stretches with an error of 1e-5 each; the rings of directions are more
    // exact than that.
    CHECK(std::abs(meanVisibility(smooth) - expected) < 3e-4);
    CHECK(smooth.colour.at(0, 0)[1] == Approx(0.5 * meanVisibility(smooth)).epsilon(1e-5));
    const ReferencePicture random = renderReference(grid, scene, monteCarlo(100'000));
    const double error = random.standardError.at(0, 0)[0];
    CHECK(std::abs(random.colour.at(0, 0)[0] - 0.8 * expected) < 4 * error);
    // The error is not larger than that of a fair coin, and not next to nothing.
    CHECK(error < 0.8 * 0.5 * 1.001 / std::sqrt(1e5));
    CHECK(error > 0.08 * 0.5 / std::sqrt(1e5));
  }
}

// V(r) at a distance r from the centre of a ball of radius R is the mean, over the cosine mu of the way out,
// of exp(-sigma_t (sqrt(R^2 - r^2 (1 - mu^2)) - r mu)). At the centre it is exp(-sigma_t R). Only the ball's
// core scatters.
TEST_CASE("At the centre of a homogeneous ball the sphere of directions has its closed form", "[reference]") {
  const double R = 40, core = 5, sigma_t = 0.03;
  // The field is the squared radius, as in the closed forms of emission. Between voxels it is 0 to 3/4 too large.
  const ScalarGrid grid = fieldGrid(
      {glm::ivec3(-43), glm::ivec3(43)}, [](const glm::dvec3& p) { return glm::dot(p, p) - 0.375; }, glm::dmat4(1),
      1e4);
  const TransferFunction transfer({{core * core, {kWhite, sigma_t}},
                                   {core * core, {glm::dvec3(0), sigma_t}},
                                   {R * R, {glm::dvec3(0), sigma_t}},
                                   {R * R, {glm::dvec3(0), 0}}});
  const auto visibility = [&](double r) {
    return 0.5 * integral(-1, 1, [&](double mu) {
             return std::exp(-sigma_t * (std::sqrt(R * R - r * r * (1 - mu * mu)) - r * mu));
           });
  };
  CHECK(visibility(0) == Approx(std::exp(-sigma_t * R)).epsilon(1e-12));
  const double expected =
      integral(-core, core, [&](double t) { return std::exp(-sigma_t * (R + t)) * sigma_t * visibility(std::abs(t)); });
  const ResolvedScene scene = lookingDownAt(transfer, Model::ambient, 0.21, 1);
  // The core's surface lies within 3/8 of a squared voxel of 25, which shortens or lengthens the ray by 1.5 % at most.
  // For this ray, at x = 0.21 and y = 0, the excess is 0.17 + f (1 - f) in z, which is 0.375 - 0.17 off where z is
  // between 0 and 3/4.
  const double bound = 0.375 / (2 * core * core);
  const ReferencePicture smooth = renderReference(grid, scene, quadrature(200));
  CHECK(smooth.colour.at(0, 0)[0] == Approx(expected).epsilon(bound));
  const ReferencePicture random = renderReference(grid, scene, monteCarlo(200'000));
  CHECK(std::abs(random.colour.at(0, 0)[0] - expected) < 4 * random.standardError.at(0, 0)[0] + bound * expected);
}

TEST_CASE("Without a medium in the way all light arrives, with an opaque one none", "[reference]") {
  const ScalarGrid grid = floorAndRoof();
  for (const Model model : {Model::cone, Model::coneRay, Model::ambient}) {
    ResolvedScene scene = lookingDownAt(floorAndRoofTransfer(), model, 4, 1);
    scene.clipPlanes = {{0, 0, -1, 9}};  // takes the roof off
    // The floor shades itself by its own depth, along a slanted path, at most in the whole upper half.
    CHECK(meanVisibility(renderReference(grid, scene, quadrature(200))) == Approx(1).epsilon(100 * kFloorDepth));
    scene.clipPlanes.clear();
    scene.camera.eye.x = scene.camera.lookAt.x = 100;  // onto the roof, which is all that there is
    const ReferencePicture above = renderReference(grid, scene, quadrature(200));
    CHECK(above.colour.at(0, 0)[3] == 1);
    scene.camera.eye.z = -40;
    scene.camera.lookAt.z = 0;
    CHECK(renderReference(grid, scene, quadrature(200)).colour.at(0, 0)[3] == 1);
  }
}
