// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/turned_camera.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

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
