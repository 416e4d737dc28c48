// Which way volumes stand, and what views are called.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/orientation.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/scene/resolve.h"

using namespace umbrick;
using Catch::Matchers::Contains;

namespace {

ScalarGrid inSpace(const std::string& space, const glm::ivec3& dims = glm::ivec3(8)) {
  const ScalarGrid grid = makeFilled(dims, glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
  const auto copy = grid.grid->deepCopy();
  if (!space.empty()) copy->insertMeta("space", openvdb::StringMetadata(space));
  return makeGrid(copy);
}

// Where the eye is, seen from the middle of the volume.
glm::dvec3 eyeOf(std::string_view view, const Orientation& orientation) {
  const OrbitView orbit = orbitView(settledOrbit(namedView(view, Orbit{}, orientation), orientation));
  Box bounds;
  bounds.include(glm::dvec3(-1));
  bounds.include(glm::dvec3(1));
  return glm::normalize(orbitCamera(bounds, orbit).eye);
}

}  // namespace

TEST_CASE("A view of a patient is the same in every anatomical space", "[render]") {
  // The directions of the eye: left, posterior and superior of the patient, in the axes of each space.
  struct Space {
    const char* name;
    glm::dvec3 left, posterior, superior;
  };
  for (const Space& space :
       {Space{"LPS", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, Space{"RAS", {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
        Space{"LAS", {1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, Space{"SPR", {0, 0, -1}, {0, 1, 0}, {1, 0, 0}}}) {
    CAPTURE(space.name);
    const Orientation orientation = orientationOf(inSpace(space.name));
    CHECK(orientation.anatomy);
    const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; };
    CHECK(near(eyeOf("anterior", orientation), -space.posterior));
    CHECK(near(eyeOf("front", orientation), -space.posterior));
    CHECK(near(eyeOf("posterior", orientation), space.posterior));
    CHECK(near(eyeOf("left", orientation), space.left));
    CHECK(near(eyeOf("right", orientation), -space.left));
    CHECK(near(eyeOf("superior", orientation), space.superior));
    CHECK(near(eyeOf("inferior", orientation), -space.superior));
  }
}

TEST_CASE("Of a thing without anatomy left is what lies on the left in the view of its front", "[render]") {
  const Orientation orientation = orientationOf(inSpace(""));
  CHECK_FALSE(orientation.anatomy);
  CHECK(orientation.up == Axis::z);
  CHECK(eyeOf("left", orientation).x == Approx(-1));
  CHECK(eyeOf("top", orientation).z == Approx(1));
  CHECK_THROWS_WITH(namedView("anterior", Orbit{}, orientation),
                    Contains("front, back, left, right, top, bottom") && Contains("anatomy"));
  CHECK_THROWS_WITH(namedView("sideways", Orbit{}, orientation), Contains("found 'sideways'") && !Contains("anatomy"));
}

TEST_CASE("Grids that other programs wrote stand with y up unless something speaks for z", "[render]") {
  CHECK(orientationOf(inSpace("", {8, 20, 8}), true).up == Axis::y);
  CHECK(orientationOf(inSpace("", {8, 20, 8}), true).front == Axis::z);
  CHECK(orientationOf(inSpace("", {8, 8, 20}), true).up == Axis::z);
  CHECK(orientationOf(inSpace("", {8, 20, 8}), true, "Blender/OpenVDBWriter").up == Axis::z);
  CHECK(orientationOf(inSpace("RAS", {8, 20, 8}), true).up == Axis::z);
  CHECK(orientationOf(inSpace("", {8, 20, 8}), false).up == Axis::z);
}

TEST_CASE("An up that is given has its usual front, and axes that agree are left alone", "[render]") {
  const Orientation patient = orientationOf(inSpace("RAS"));
  Orbit orbit;
  CHECK(settledOrbit(orbit, patient).front == Axis::y);
  orbit.up = Axis::y;
  CHECK(settledOrbit(orbit, patient).front == Axis::z);
  orbit.front = Axis::minusY;
  CHECK_THROWS_WITH(settledOrbit(orbit, patient), Contains("camera.frontAxis") && Contains("found -y"));
}
