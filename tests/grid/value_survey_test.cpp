// What is counted of a grid's values: against closed forms and against counting voxel by voxel.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/value_survey.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "support/test_grids.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;

TEST_CASE("A survey of a ramp has a flat histogram and its slope as the gradient", "[grid]") {
  const ScalarGrid grid = makeFilled({64, 24, 24}, {-8, 8, 0}, [](const glm::ivec3& at) { return 3.0 * at.x + 10; });
  const ValueSurvey survey = surveyValues(grid);
  CHECK(survey.voxels == 64 * 24 * 24);
  CHECK(survey.boxVoxels == survey.voxels);
  CHECK(survey.value.min == 10);
  CHECK(survey.value.max == 10 + 3 * 63);
  CHECK(std::accumulate(survey.histogram.begin(), survey.histogram.end(), 0.0) == double(survey.voxels));
  for (std::size_t bin = 0; bin < survey.histogram.size(); ++bin) {
    const double count = survey.histogram[bin];
    CHECK((count == 0 || count == 24 * 24));
    if (survey.gradient[bin] > 0) CHECK(survey.gradient[bin] == Approx(3).epsilon(1e-6));
  }
  CHECK(survey.wholeNumbers);
  CHECK(survey.distinct.size() == 64);
  CHECK(survey.jumps == 0);  // neighbours are next in value
}

TEST_CASE("Values that are not finite are no values, and one outlier does not stretch the histogram", "[grid]") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const ScalarGrid grid = makeFilled({40, 40, 40}, glm::ivec3(0), [&](const glm::ivec3& at) -> double {
    if (at == glm::ivec3(0)) return nan;
    if (at == glm::ivec3(1)) return infinity;
    return at == glm::ivec3(2) ? 1e20 : 1 + 0.01 * at.x;
  });
  const ValueSurvey survey = surveyValues(grid);
  CHECK(survey.voxels == 40 * 40 * 40 - 2);
  CHECK(survey.value.max == 1e20f);
  CHECK(survey.high < 2);
  CHECK_FALSE(survey.wholeNumbers);
  CHECK(survey.distinct.empty());
}

TEST_CASE("Labels jump from one to another, and steps of an image do not", "[grid]") {
  const auto label = [](const glm::ivec3& at) { return double((at.x / 4 * 7 + at.y / 4 * 3 + at.z / 4 * 5) % 11 + 1); };
  CHECK(surveyValues(makeFilled({32, 32, 32}, glm::ivec3(0), label)).jumps > 0.5);
  const auto step = [](const glm::ivec3& at) { return double(at.x / 4 + 1); };
  const ValueSurvey steps = surveyValues(makeFilled({32, 32, 32}, glm::ivec3(0), step));
  CHECK(steps.jumps == 0);
  CHECK(steps.distinct.size() == 8);
  CHECK(steps.distinct[3] == std::pair<double, std::uint64_t>(4, 4 * 32 * 32));
}

TEST_CASE("Columns through a ball are as long as its chords", "[grid]") {
  constexpr double kRadius = 20, kEdge = 0.25;
  const auto ball = [&](const glm::ivec3& at) { return glm::length(glm::dvec3(at) - 24.0) < kRadius ? 1.0 : 0.0; };
  const ScalarGrid grid = withTransform(makeFilled(glm::ivec3(49), glm::ivec3(0), ball), glm::dmat4(glm::dmat3(kEdge)));
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> columns = columnIntegrals(grid, axis, [](double value) { return 2 * value; });
    const double sum = std::accumulate(columns.begin(), columns.end(), 0.0);
    // The volume of the ball over the area of a column, to the roughness of its surface.
    CHECK(sum == Approx(2 * kEdge * 4.18879 * kRadius * kRadius * kRadius).epsilon(0.01));
    CHECK(*std::max_element(columns.begin(), columns.end()) == Approx(2 * kEdge * 39));
    CHECK(double(columns.size()) == Approx(3.14159 * kRadius * kRadius).epsilon(0.02));
  }
}

TEST_CASE("Tiles count as the voxels that they stand for", "[grid]") {
  const auto tree = openvdb::FloatGrid::create(0);
  tree->tree().addTile(1, openvdb::Coord(8, 16, 24), 2.5f, true);   // 8^3
  tree->tree().addTile(2, openvdb::Coord(128, 0, 0), 4.0f, true);   // 128^3
  tree->tree().addTile(1, openvdb::Coord(400, 0, 0), 9.0f, false);  // inactive
  const ScalarGrid tiles = makeGrid(tree);
  const auto filled = tree->deepCopy();
  filled->tree().voxelizeActiveTiles();
  const ScalarGrid voxels = makeGrid(filled);
  const ValueSurvey a = surveyValues(tiles), b = surveyValues(voxels);
  CHECK(a.voxels == b.voxels);
  CHECK(a.histogram == b.histogram);
  CHECK(a.distinct == b.distinct);
  for (int axis = 0; axis < 3; ++axis) {
    const auto weight = [](double value) { return value; };
    const std::vector<double> x = columnIntegrals(tiles, axis, weight), y = columnIntegrals(voxels, axis, weight);
    REQUIRE(x.size() == y.size());
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == Approx(y[i]));
  }
  CHECK(acceptedBox(tiles, [](double v) { return v > 1; }) == acceptedBox(voxels, [](double v) { return v > 1; }));
  CHECK(acceptedBox(tiles, [](double v) { return v < 3; }) == IndexBox{{8, 16, 24}, {15, 23, 31}});
}

TEST_CASE("Columns of a grid that is wider than the picture are means", "[grid]") {
  const ScalarGrid grid = makeFilled({3, 1100, 2}, glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
  const std::vector<double> columns = columnIntegrals(grid, 0, [](double value) { return value; });
  CHECK(columns.size() < 512);
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) CHECK(columns[i] <= 3);
  CHECK(columns.front() == Approx(3 * 2.0 / 3));  // columns are 3 voxels wide, of which 2 are there across
}

TEST_CASE("The box of accepted voxels is exact, and empty for none", "[grid]") {
  const ScalarGrid grid = makeSparse({-40, 3, 9}, 5);
  IndexBox expected;
  bool first = true;
  for (auto voxel = grid.grid->cbeginValueOn(); voxel; ++voxel) {
    if (!(*voxel > 0.5f)) continue;
    const openvdb::Coord at = voxel.getCoord();
    const glm::ivec3 index(at.x(), at.y(), at.z());
    expected = first ? IndexBox{index, index} : IndexBox{glm::min(expected.min, index), glm::max(expected.max, index)};
    first = false;
  }
  CHECK(acceptedBox(grid, [](double value) { return value > 0.5; }) == expected);
  CHECK(acceptedBox(grid, [](double) { return false; }).empty());
}

TEST_CASE("The largest gradient is that of central differences in the world, whatever holds the voxels", "[grid]") {
  // Of a cone its slope, in voxels that are twice as long along z.
  const ScalarGrid cone = withTransform(
      makeFilled(
          glm::ivec3(40), glm::ivec3(-20), [](const glm::ivec3& i) { return 30.0 - (i.x - 20.0) - 2 * (i.z - 20.0); },
          0),
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 2, 0), glm::dvec4(5, 6, 7, 1)));
  double largest = 0;
  const auto accessor = cone.grid->getConstAccessor();
  for (auto voxel = cone.grid->cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Coord at = voxel.getCoord();
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Coord above = at, below = at;
      ++above[axis];
      --below[axis];
      slope[axis] = (double(accessor.getValue(above)) - double(accessor.getValue(below))) / (axis == 2 ? 4 : 2);
    }
    largest = std::max(largest, glm::length(slope));
  }
  CHECK(largestGradient(cone) == Approx(largest).epsilon(1e-12));
  // A cube of tiles drops to the background at its corner.
  auto tiles = openvdb::FloatGrid::create(1);
  tiles->denseFill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(15)), 4, true);
  tiles->tree().prune();
  REQUIRE(tiles->activeVoxelCount() == 16 * 16 * 16);
  REQUIRE(tiles->tree().leafCount() == 0);
  CHECK(largestGradient({tiles, "tiles"}) == Approx(std::sqrt(3.0) * 1.5));
}
