// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/camera.h"

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
}
