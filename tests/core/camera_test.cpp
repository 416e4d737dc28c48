// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/camera.h"
#include "umbrick/core/axis.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "umbrick/core/error.h"

using namespace umbrick;

TEST_CASE("View axes are orthonormal and right-handed", "[core]") {
  Camera camera;
  camera.eye = {3, -7, 2};
  camera.lookAt = {-1, 4, 0.5};
  camera.up = {0.1, 0.2, 5};
  const CameraFrame f = cameraFrame(camera);
  CHECK(glm::length(f.right) == Approx(1));
  CHECK(glm::length(f.up) == Approx(1));
  CHECK(std::abs(glm::dot(f.right, f.up)) < 1e-14);
  CHECK(std::abs(glm::dot(f.right, f.forward)) < 1e-14);
  CHECK(glm::dot(glm::cross(f.right, f.up), -f.forward) == Approx(1));
}

TEST_CASE("An orbit camera sees the bounding sphere from every side, poles included", "[core]") {
  Box bounds;
  bounds.include({10, 20, 30});
  bounds.include({14, 22, 39});
  const double radius = 0.5 * glm::length(bounds.extent());
  for (const Projection projection : {Projection::perspective, Projection::orthographic})
    for (const int width : {200, 512, 900})
      for (const double elevation : {-1.5707963267948966, -0.4, 0.0, 1.5707963267948966})
        for (const double azimuth : {0.0, 1.0, 4.0}) {
          Camera base;
          base.projection = projection;
          base.width = width;
          const Camera camera = orbitCamera(bounds, azimuth, elevation, base);
          const CameraFrame f = cameraFrame(camera);
          const double distance = glm::dot(bounds.centre() - camera.eye, f.forward);
          CHECK(distance > radius);
          const glm::dvec2 extent = screenPlane(camera).halfExtent;
          const double narrow = std::min(extent.x, extent.y);
          // The silhouette of the sphere, as a radius on the screen plane.
          const double silhouette = projection == Projection::perspective
                                        ? radius / std::sqrt(distance * distance - radius * radius)
                                        : radius;
          CHECK(silhouette == Approx(narrow));
        }
}

TEST_CASE("Azimuth turns the eye counter-clockwise as seen from above", "[core]") {
  Box bounds;
  bounds.include(glm::dvec3(-1));
  bounds.include(glm::dvec3(1));
  CHECK(orbitCamera(bounds, 0, 0).eye.y < -1);
  CHECK(orbitCamera(bounds, 1.5707963267948966, 0).eye.x > 1);
}

TEST_CASE("Whatever is up, an orbit sees the front upright and its left on the left", "[core]") {
  Box bounds;
  bounds.include(glm::dvec3(-1, -2, -3));
  bounds.include(glm::dvec3(4, 5, 6));
  for (const Axis up : {Axis::x, Axis::y, Axis::z, Axis::minusX, Axis::minusY, Axis::minusZ}) {
    CAPTURE(nameOf(kAxes, up));
    OrbitView view;
    view.up = axisDirection(up);
    view.front = axisDirection(usualFront(up));
    const CameraFrame frame = cameraFrame(orbitCamera(bounds, view));
    CHECK(glm::length(frame.forward + view.front) < 1e-14);
    CHECK(glm::length(frame.up - view.up) < 1e-14);
    // A quarter turn brings the eye to where the right side was.
    view.azimuth = 1.5707963267948966;
    CHECK(glm::length(cameraFrame(orbitCamera(bounds, view)).forward + frame.right) < 1e-14);
  }
  // With z up this is the camera of angles alone, to the last bit.
  const Camera angles = orbitCamera(bounds, 0.7, 0.3), same = orbitCamera(bounds, OrbitView{0.7, 0.3});
  CHECK(angles == same);
}

TEST_CASE("Zooming enlarges and panning moves without turning the view", "[core]") {
  Box bounds;
  bounds.include(glm::dvec3(-1));
  bounds.include(glm::dvec3(1, 2, 3));
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Camera base;
    base.projection = projection;
    const Camera plain = orbitCamera(bounds, OrbitView{0.4, 0.2}, base);
    OrbitView view{0.4, 0.2};
    view.zoom = 2.5;
    const Camera zoomed = orbitCamera(bounds, view, base);
    CHECK(zoomed.eye == plain.eye);
    CHECK(screenPlane(plain).halfExtent.y == Approx(2.5 * screenPlane(zoomed).halfExtent.y).epsilon(1e-14));
    view.pan = {0.25, -0.5};
    const Camera moved = orbitCamera(bounds, view, base);
    const CameraFrame frame = cameraFrame(moved);
    CHECK(glm::length(frame.forward - cameraFrame(plain).forward) < 1e-14);
    // The centre of the volume is a quarter of the picture's height to the right, and half of it down.
    const glm::dvec3 offset = bounds.centre() - moved.eye;
    const double depth = projection == Projection::perspective ? glm::dot(offset, frame.forward) : 1;
    const double height = 2 * screenPlane(moved).halfExtent.y;
    CHECK(glm::dot(offset, frame.right) / depth / height == Approx(0.25).epsilon(1e-13));
    CHECK(glm::dot(offset, frame.up) / depth / height == Approx(-0.5).epsilon(1e-13));
  }
}

TEST_CASE("A filling zoom brings the outermost corner to the border and none beyond", "[core]") {
  Box bounds;
  bounds.include(glm::dvec3(3, -2, 1));
  bounds.include(glm::dvec3(4, 9, 2));
  for (const Projection projection : {Projection::perspective, Projection::orthographic})
    for (const int width : {300, 512, 800}) {
      Camera base;
      base.projection = projection;
      base.width = width;
      OrbitView view{0.9, -0.3};
      view.zoom = fillingZoom(orbitCamera(bounds, view, base), bounds);
      CHECK(view.zoom > 0.9);  // a box may fill the sphere that an orbit leaves room for
      CHECK(fillingZoom(orbitCamera(bounds, view, base), bounds) == Approx(1).epsilon(1e-12));
    }
}

TEST_CASE("A camera that cannot see is refused with the field that is wrong", "[core]") {
  Camera same;
  same.lookAt = same.eye;
  CHECK_THROWS_AS(cameraFrame(same), InvalidArgument);
  Camera along;
  along.up = {0, 0, 3};
  CHECK_THROWS_WITH(cameraFrame(along), Catch::Contains("up is parallel"));
  Camera flat;
  flat.width = 0;
  CHECK_THROWS_WITH(cameraFrame(flat), Catch::Contains("0 x 512"));
  Camera wide;
  wide.fov = 3.2;
  CHECK_THROWS_WITH(screenPlane(wide), Catch::Contains("fov"));
  CHECK_THROWS_WITH(orbitCamera(Box{}, 0, 0), Catch::Contains("empty"));
  Box unit;
  unit.include(glm::dvec3(0));
  unit.include(glm::dvec3(1));
  OrbitView tilted;
  tilted.front = tilted.up;
  CHECK_THROWS_WITH(orbitCamera(unit, tilted), Catch::Contains("up and front"));
  OrbitView none;
  none.zoom = 0;
  CHECK_THROWS_WITH(orbitCamera(unit, none), Catch::Contains("zoom is 0"));
  CHECK_THROWS_WITH(axisDirection(Axis::automatic), Catch::Contains("auto"));
}
