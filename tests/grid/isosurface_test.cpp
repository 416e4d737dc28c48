// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/isosurface.h"

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetMeasure.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <numbers>

#include "support/complaint.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// A volume that is 5000 on a sphere around `centre` and grows by 100 for each world unit inwards.
ScalarGrid ball(const glm::ivec3& dims, const glm::dmat4& place, const glm::dvec3& centre, double radius) {
  const auto value = [&](const glm::ivec3& at) {
    const glm::dvec3 point(place * glm::dvec4(at, 1));
    return std::max(5000 + 100 * (radius - glm::distance(point, centre)), 0.0);
  };
  return withTransform(makeFilled(dims, glm::ivec3(0), value), place);
}

double distanceAt(const Isosurface& surface, const glm::dvec3& point) {
  return double(openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler>(*surface.grid)
                    .wsSample({point.x, point.y, point.z}));
}

// Checks the signed distances of points in all directions, on the sphere and a little inside and outside of it.
void checkSphere(const Isosurface& surface, const glm::dvec3& centre, double radius) {
  TestRandom random(3);
  double worst = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 direction = glm::normalize(random.point(glm::dvec3(-1), glm::dvec3(1)));
    for (const double offset : {-1.0, 0.0, 1.0})
      worst = std::max(worst,
                       std::abs(distanceAt(surface, centre + (radius + offset * surface.report.voxelSize) * direction) /
                                    surface.report.voxelSize -
                                offset));
  }
  CHECK(worst < 0.1);  // voxels
  CHECK(distanceAt(surface, centre) == -double(surface.grid->background()));
  // The volume may be off by a tenth of a voxel on the whole surface.
  const double ballVolume = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  CHECK(openvdb::tools::levelSetVolume(*surface.grid) ==
        Approx(ballVolume).margin(0.1 * surface.report.voxelSize * 4 * std::numbers::pi * radius * radius));
}

}  // namespace

TEST_CASE("The isosurface of a ball is its sphere to a tenth of a voxel, in cubes at any place", "[grid]") {
  const glm::dmat4 turned = glm::scale(
      glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(-300, 20, 7)), 0.7, glm::normalize(glm::dvec3(1, 2, 3))),
      glm::dvec3(0.5));
  for (const glm::dmat4& place : {glm::dmat4(1), turned, glm::scale(turned, glm::dvec3(1, -1, 1))}) {
    const double voxel = glm::length(glm::dvec3(place[0]));
    const glm::dvec3 centre(place * glm::dvec4(21.3, 20.2, 19.6, 1));
    const ScalarGrid volume = ball({42, 42, 42}, place, centre, 15 * voxel);
    const Isosurface surface = makeIsosurface(volume, {5000});
    CHECK(surface.grid->getGridClass() == openvdb::GRID_LEVEL_SET);
    CHECK(surface.grid->transform() == volume.grid->transform());
    CHECK(double(surface.grid->background()) == Approx(3 * voxel));
    checkSphere(surface, centre, 15 * voxel);
    CHECK(surface.report.crossings > 4000);  // edges along each axis cross pi 15^2 twice: 4240 in all
    CHECK(surface.report.maxError < 0.1);
    CHECK(surface.report.rmsError < 0.03);
    CHECK(surface.report.activeVoxels == surface.grid->activeVoxelCount());
  }
}

TEST_CASE("Voxels that are not cubes become cubes of the smallest spacing", "[grid]") {
  const glm::dmat4 flat = glm::scale(glm::rotate(glm::dmat4(1), 0.4, glm::dvec3(0, 0, 1)), glm::dvec3(0.8, 0.8, 1.5));
  for (const glm::dmat4& place : {flat, crookedTransform()}) {
    const glm::dvec3 centre(place * glm::dvec4(30, 30, 18, 1));
    const Isosurface surface = makeIsosurface(ball({61, 61, 37}, place, centre, 14), {5000, 4});
    CHECK(surface.grid->transform().hasUniformScale());
    CHECK(surface.report.voxelSize <= glm::length(glm::dvec3(place[0])) * (1 + 1e-12));
    CHECK(surface.grid->voxelSize()[0] == Approx(surface.report.voxelSize));
    CHECK(double(surface.grid->background()) == Approx(4 * surface.report.voxelSize));
    checkSphere(surface, centre, 14);
    // Along its long edges the volume itself is coarser than the cubes.
    CHECK(surface.report.maxError < 0.3);
  }
}

// Beyond five voxels distances are swept, to first order: some percent of what is beyond.
TEST_CASE("A wide band reaches as far as it is asked to", "[grid]") {
  const glm::dvec3 centre(40);
  const Isosurface surface = makeIsosurface(ball({81, 81, 81}, glm::dmat4(1), centre, 20), {5000, 12});
  CHECK(surface.grid->background() == 12);
  TestRandom random(5);
  double worst = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 direction = glm::normalize(random.point(glm::dvec3(-1), glm::dvec3(1)));
    for (const double offset : {-10.0, -7.0, -4.0, 4.0, 7.0, 10.0})
      worst = std::max(worst, std::abs(distanceAt(surface, centre + (20 + offset) * direction) - offset));
  }
  CHECK(worst < 0.35);
  CHECK(distanceAt(surface, centre) == -12);
  CHECK(surface.report.maxError < 0.1);
}

// Along each edge of the volume the value is crossed where it should be, whatever the values: thin sheets, lone voxels
// and noise keep their surface, also between the voxels of another lattice.
TEST_CASE("The isosurface of noise keeps all of its crossings", "[grid]") {
  TestRandom random(9);
  const auto noise = [&](const glm::ivec3&) { return random.uniform(0, 1); };
  for (const glm::dvec3& spacing : {glm::dvec3(1), glm::dvec3(1, 1, 2.7)}) {
    const ScalarGrid volume =
        withTransform(makeFilled({20, 20, 20}, glm::ivec3(0), noise), glm::scale(glm::dmat4(1), spacing));
    const Isosurface surface = makeIsosurface(volume, {0.5f});
    CHECK(surface.report.crossings > 8000);
    CHECK(surface.report.maxError < 0.5);
    CHECK(surface.report.rmsError < 0.08);
  }
}

TEST_CASE("Cavities are outside, and so is what lies beyond the faces of a volume", "[grid]") {
  // The volume is a shell of radii 6 to 13 around (15, 15, 15), cut by the face x = 15.
  const auto value = [](const glm::ivec3& at) {
    const double radius = glm::distance(glm::dvec3(at), glm::dvec3(15));
    return std::max(5 - std::abs(radius - 9.5), 0.0);
  };
  const ScalarGrid whole = makeFilled({31, 31, 31}, glm::ivec3(0), value);
  const Isosurface shell = makeIsosurface(whole, {1.5f});
  CHECK(distanceAt(shell, {15, 15, 15}) == 3);
  CHECK(distanceAt(shell, {15, 15, 24.5}) < -2.9);
  CHECK(distanceAt(shell, {15, 15, 30}) == Approx(2).margin(0.1));
  CHECK(distanceAt(shell, {15, 15, 21}) == Approx(0).margin(0.1));
  const Isosurface cut = makeIsosurface(makeFilled({16, 31, 31}, glm::ivec3(0), value), {1.5f});
  CHECK(distanceAt(cut, {10, 15, 15 + 8}) < 0);
  CHECK(distanceAt(cut, {17, 15, 24.5}) > 0);
  CHECK(distanceAt(cut, {15, 15, 24.5}) < 0);
}

// Leaves of one value become tiles, and these have no leaf beside them.
TEST_CASE("Solid blocks have a surface where value meets background", "[grid]") {
  const auto grid = openvdb::FloatGrid::create(0);
  grid->tree().addTile(1, {0, 0, 0}, 4.0f, true);
  grid->tree().addTile(1, {8, 0, 0}, 4.0f, true);
  const Isosurface block = makeIsosurface(makeGrid(grid), {1.0f});
  CHECK(block.report.crossings == 2 * (16 * 8 * 2 + 8 * 8));
  CHECK(distanceAt(block, {7.5, 3.5, 3.5}) == -3);
  for (const double z : {-0.75, 7.75}) CHECK(distanceAt(block, {7.5, 3.5, z}) == Approx(0).margin(0.01));
  // A voxel that has exactly the value is inside.
  CHECK(distanceAt(makeIsosurface(makeGrid(grid), {4.0f}), {7.5, 3.5, 3.5}) == -3);
}

// Cubes have the smallest spacing, so that a face of a voxel may be as many of them as one likes.
TEST_CASE("A level set that no machine could hold is refused before it is made", "[grid]") {
  const glm::dmat4 flat = glm::scale(glm::dmat4(1), glm::dvec3(1e-6, 1, 1));
  const std::string said = complaint<MemoryError>([&] {
    makeIsosurface(ball(glm::ivec3(24), flat, {1.2e-5, 12, 12}, 8), {.value = 5000});
  });
  CHECK_THAT(said, Contains("grid \"density\": isosurface: a band of some ") && Contains(" of memory, there is "));
}

TEST_CASE("Where there is no isosurface, the message has the expected and the found value", "[grid]") {
  const ScalarGrid volume = ball({20, 20, 20}, glm::dmat4(1), glm::dvec3(10), 5);
  const auto refused = [](const ScalarGrid& grid, const IsosurfaceOptions& options, const char* message) {
    CHECK_THAT(complaint<InvalidArgument>([&] { makeIsosurface(grid, options); }), Contains(message));
  };
  refused(volume, {1e6f},
          "grid \"density\": isosurface: expected a value that the volume crosses, from 0 to 5500, found");
  refused(volume, {-3}, "expected a value above the background of 0, which is outside, found -3");
  refused(volume, {std::nanf("")}, "expected a finite value, found nan");
  refused(volume, {5000, 0.5f}, "expected a half width from 1 to 100 voxels, found 0.5");
  refused(makeSphereLevelSet(), {1}, "expected a fog volume, found a level set");
}
