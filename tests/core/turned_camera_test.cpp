// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/turned_camera.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "umbrick/core/error.h"

using namespace umbrick;

TEST_CASE("A camera that is turned around what an orbit looks at is that orbit's camera at another azimuth", "[core]") {
  Box box;
  box.include({-3, 1, 2});
  box.include({4, 2, 9});
  OrbitView view{.azimuth = 0.3, .elevation = -0.4, .zoom = 1.7, .pan = {0.2, -0.1}};
  SECTION("z up") {}
  SECTION("y up") { view.up = {0, 1, 0}, view.front = {0, 0, 1}; }
  Camera base;
  SECTION("parallel") { base.projection = Projection::orthographic; }
  const double angle = 2.1;
  const Camera turned = turnedCamera(orbitCamera(box, view, base), box.centre(), 3.0 * view.up, angle);
  view.azimuth += angle;
  const Camera expected = orbitCamera(box, view, base);
  const auto apart = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); };
  // Both are the same formula in another order: only rounding is between them.
  CHECK(apart(turned.eye, expected.eye) < 1e-12);
  CHECK(apart(turned.lookAt, expected.lookAt) < 1e-12);
  CHECK(apart(turned.up, expected.up) < 1e-12);
  CHECK(turned.fov == expected.fov);
  CHECK(turned.viewHeight == expected.viewHeight);
}

TEST_CASE("A camera that is not turned is equal to the last bit", "[core]") {
  Camera camera;
  camera.eye = {0.1, 0.7, 1.3};
  CHECK(turnedCamera(camera, {3, 1, 4}, {1, 5, 9}, 0) == camera);
  CHECK_THROWS_AS(turnedCamera(camera, {}, {0, 0, 0}, 1), InvalidArgument);
}

TEST_CASE("A picture rolls by the angle that its up turns around the view, and not by turns of the view", "[core]") {
  const Camera camera{.eye = {4, 1, 2}, .lookAt = {0, 0, 0}, .up = {0, 0, 1}};
  for (const double angle : {0.0, 0.3, 1.0, 3.0})
    CHECK(rollBetween(camera, turnedCamera(camera, camera.eye, camera.lookAt - camera.eye, angle)) ==
          Approx(angle).margin(1e-7));
  // Turned as a whole around an axis at right angles to the view, it does not roll.
  const CameraFrame frame = cameraFrame(camera);
  for (const double angle : {0.2, 1.5, 3.0})
    CHECK(rollBetween(camera, turnedCamera(camera, camera.eye, frame.up + frame.right, angle)) < 1e-7);
  // Over the pole, the picture turns over.
  const Camera before{.eye = {0.1, 0, 5}, .lookAt = {0, 0, 0}, .up = {0, 0, 1}},
      after{.eye = {-0.1, 0, 5}, .lookAt = {0, 0, 0}, .up = {0, 0, 1}};
  CHECK(rollBetween(before, after) == Approx(std::numbers::pi));
}
