// Which bricks there are and what is said of them: ranges, gradients, formats, domain, limits.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <glm/matrix.hpp>

#include "support/test_grids.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;

namespace {
constexpr int kLargest = std::numeric_limits<std::int32_t>::max();

const Brick* brickAt(const Bricks& bricks, const glm::ivec3& origin) {
  for (const Brick& brick : bricks.bricks)
    if (brick.origin == origin) return &brick;
  return nullptr;
}

VoxelFormat formatOf(const ScalarGrid& grid) { return brickGrid(grid)->exactFormat; }
}  // namespace

TEST_CASE("A brick's range is that of its interior and apron, and only background is left out", "[brick]") {
  const ScalarGrid grids[] = {makeNoise({37, 30, 21}, {-9, 2, 5}), makeSparse({-30, 0, 0}, 3, 5, 80),
                              makeSphereLevelSet(12), makeTiles(1.5f)};
  for (const ScalarGrid& grid : grids)
    for (const auto& [interior, apron] : {std::pair(8, 1), {8, 2}, {16, 1}, {24, 5}}) {
      INFO("interior " << interior << ", apron " << apron);
      const auto bricks = brickGrid(grid, {interior, apron});
      const auto accessor = grid.grid->getConstAccessor();
      std::size_t found = 0;
      const IndexBox reach = bricks->reach();
      const glm::ivec3 first = glm::ivec3(glm::floor(glm::dvec3(reach.min) / double(interior))) * interior;
      for (int z = first.z; z <= reach.max.z; z += interior)
        for (int y = first.y; y <= reach.max.y; y += interior)
          for (int x = first.x; x <= reach.max.x; x += interior) {
            Range range;
            for (int k = z - apron; k < z + interior + apron; ++k)
              for (int j = y - apron; j < y + interior + apron; ++j)
                for (int i = x - apron; i < x + interior + apron; ++i)
                  range.include(accessor.getValue(openvdb::Coord(i, j, k)));
            const Brick* brick = brickAt(*bricks, {x, y, z});
            const bool holdsMore = range != Range{bricks->background, bricks->background};
            CHECK((brick != nullptr) == holdsMore);
            if (!brick) continue;
            CHECK(brick->value == range);
            CHECK(brick->gradient == Range{0, 0});
            ++found;
          }
      CHECK(found == bricks->bricks.size());
    }
}

// A sample near a face reaches into the apron, so such a brick may be visible.
TEST_CASE("A brick with an empty interior but an occupied apron exists", "[brick]") {
  const auto bricks = brickGrid(makeVoxels({{{31, 5, 5}, 2.0f}}), {32});
  REQUIRE(bricks->bricks.size() == 2);
  CHECK(bricks->bricks[0].origin == glm::ivec3(0));
  CHECK(bricks->bricks[1].origin == glm::ivec3(32, 0, 0));
  CHECK(bricks->bricks[1].value == Range{0, 2});
}

TEST_CASE("One voxel at a corner reaches eight bricks", "[brick]") {
  const auto bricks = brickGrid(makeVoxels({{{-32, 64, 0}, -1.0f}}), {32});
  CHECK(bricks->bricks.size() == 8);
  CHECK(bricks->domain == IndexBox{{-33, 63, -1}, {-31, 65, 1}});
  CHECK(bricks->value == Range{-1, 0});
  CHECK(backgroundBricks(*bricks).empty());
}

TEST_CASE("An empty grid has no bricks and an empty domain", "[brick]") {
  const ScalarGrid grid = makeVoxels({}, 0.25f);
  for (const auto& bricks : {brickGrid(grid), unbrickedGrid(grid)}) {
    CHECK(bricks->bricks.empty());
    CHECK(bricks->domain.empty());
    CHECK(bricks->value == Range{0.25f, 0.25f});
    CHECK(bricks->gradient == Range{0, 0});
    CHECK(backgroundBricks(*bricks).empty());
  }
}

TEST_CASE("Active voxels of the background's value belong to the domain but need no brick", "[brick]") {
  const auto bricks = brickGrid(makeVoxels({{{0, 0, 0}, 0.0f}, {{10, 20, 70}, 0.0f}}), {32});
  CHECK(bricks->bricks.empty());
  CHECK(bricks->domain == IndexBox{{-1, -1, -1}, {11, 21, 71}});
  CHECK(backgroundBricks(*bricks).size() == 2 * 2 * 4);
}

TEST_CASE("Inactive voxels that differ from the background are voxels like any other", "[brick]") {
  const auto sphere = brickGrid(makeSphereLevelSet(40), {16});
  CHECK(sphere->value.min == -3);
  CHECK(sphere->value.max == 3);
  const Brick* inside = brickAt(*sphere, {0, 0, 0});
  REQUIRE(inside);
  CHECK(inside->uniform());
  CHECK(inside->value == Range{-3, -3});

  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(1);
  grid->tree().setValueOff(openvdb::Coord(100, 0, 0), 7.0f);
  const auto hidden = brickGrid(makeGrid(grid), {32});
  CHECK(hidden->domain == IndexBox{{99, -1, -1}, {101, 1, 1}});
  CHECK(hidden->bricks.size() == 4);
}

TEST_CASE("Tiles of every level are enumerated, and most of their bricks are uniform", "[brick]") {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  grid->tree().addTile(3, openvdb::Coord(-4096, 0, 0), 2.0f, true);
  const auto bricks = brickGrid(makeGrid(grid), {128});
  CHECK(bricks->bricks.size() == 34 * 34 * 34);
  const auto uniform =
      std::count_if(bricks->bricks.begin(), bricks->bricks.end(), [](const Brick& brick) { return brick.uniform(); });
  CHECK(uniform == 30 * 30 * 30);
  CHECK_THROWS_AS(brickGrid(makeGrid(grid), {8}), InvalidArgument);
  CHECK_THROWS_WITH(brickGrid(makeGrid(grid), {8}), Catch::Contains("8388608") && Catch::Contains("8 x 8 x 8"));
}

TEST_CASE("A gradient is a covector: a linear field has the same one under every transform", "[brick]") {
  const glm::dvec3 slope(0.7, -0.4, 1.1);  // grid units per world unit
  for (const glm::dmat4& toWorld :
       {glm::dmat4(1), crookedTransform(), glm::dmat4(1e-3, 0, 0, 0, 0, 2e-3, 0, 0, 0, 0, 1e-3, 0, 0, 0, 0, 1),
        glm::dmat4(1e6, 0, 0, 0, 0, 1e6, 0, 0, 0, 3e5, -1e6, 0, 0, 0, 0, 1)}) {
    const auto field = [&](const glm::ivec3& p) {
      return glm::dot(slope, glm::dvec3(glm::dmat3(toWorld) * glm::dvec3(p)));
    };
    const ScalarGrid grid = withTransform(makeFilled({40, 40, 40}, {-16, -16, -16}, field), toWorld);
    const auto bricks = brickGrid(grid, {16, 1, true});
    // Cell 0 with its apron lies inside the box, so no difference reaches out of it.
    std::vector<float> values(bricks->layout.voxels()), gradients(values.size());
    bricks->read({0, 0, 0}, values, gradients);
    // The stored values are rounded, over the distance of two voxels.
    const double voxel = std::cbrt(std::abs(glm::determinant(glm::dmat3(toWorld))));
    const double tolerance = 1e-6 * glm::length(slope) + 4 * 6e-8 * bricks->value.extent() / voxel;
    double worst = 0;
    for (const float gradient : gradients) worst = std::max(worst, std::abs(gradient - glm::length(slope)));
    CHECK(worst < tolerance);
    const Brick* brick = brickAt(*bricks, {0, 0, 0});
    REQUIRE(brick);
    CHECK(brick->gradient == Range{*std::min_element(gradients.begin(), gradients.end()),
                                   *std::max_element(gradients.begin(), gradients.end())});
  }
}

// The gradient in the apron sees one voxel more than its value.
TEST_CASE("A brick of background with a gradient in its apron exists when gradients are asked for", "[brick]") {
  const ScalarGrid grid = makeVoxels({{{30, 5, 5}, 2.0f}});
  CHECK(brickAt(*brickGrid(grid, {32, 1, false}), {32, 0, 0}) == nullptr);
  // Voxel 31 has a gradient. The space behind it, which interpolates between 31 and 32, belongs to the next brick.
  const auto bricks = brickGrid(grid, {32, 1, true});
  const Brick* next = brickAt(*bricks, {32, 0, 0});
  REQUIRE(next);
  CHECK(next->value == Range{0, 0});
  CHECK(next->gradient == Range{0, 1});
}

TEST_CASE("Gradients that overflow stay finite", "[brick]") {
  // The voxels are nearly the smallest that OpenVDB accepts: it refuses a determinant below 3e-15.
  const glm::dmat4 tiny(2e-5, 0, 0, 0, 0, 2e-5, 0, 0, 0, 0, 2e-5, 0, 0, 0, 0, 1);
  const auto bricks = brickGrid(withTransform(makeVoxels({{{3, 3, 3}, 3e38f}}), tiny), {8, 1, true});
  CHECK(bricks->gradient == Range{0, std::numeric_limits<float>::max()});
}

TEST_CASE("The format is the smallest that holds every voxel exactly", "[brick]") {
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 255.0f}, {{9, 0, 0}, 3.0f}})) == VoxelFormat::unorm8);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, -1000.0f}}, -1255.0f)) == VoxelFormat::unorm8);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 256.0f}})) == VoxelFormat::unorm16);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 65535.0f}})) == VoxelFormat::unorm16);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 65535.0f}}, -1.0f)) == VoxelFormat::float32);  // 65535 needs 16 bits
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 33554432.0f}}, 33554432.0f + 64)) == VoxelFormat::unorm8);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0.5f}})) == VoxelFormat::half);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0.5f}}, 65504.0f)) == VoxelFormat::half);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0.5f}}, 65536.0f)) == VoxelFormat::float32);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0x1.004p-3f}})) == VoxelFormat::half);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0x1.002p-3f}})) == VoxelFormat::float32);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0x1p-24f}})) == VoxelFormat::half);  // the smallest half float
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0x1p-25f}})) == VoxelFormat::float32);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0x1.8p-24f}})) == VoxelFormat::float32);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 0.1f}})) == VoxelFormat::float32);
  CHECK(formatOf(makeVoxels({{{0, 0, 0}, 1e-40f}})) == VoxelFormat::float32);  // a denormal float

  // Inactive voxels, tiles and the background count.
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  grid->tree().setValueOff(openvdb::Coord(1, 1, 1), 0.1f);
  CHECK(formatOf(makeGrid(grid)) == VoxelFormat::float32);
  CHECK(formatOf(makeTiles(0)) == VoxelFormat::half);
  CHECK(formatOf(makeTiles(0.1f)) == VoxelFormat::float32);
  CHECK(formatOf(makeVoxels({}, 0)) == VoxelFormat::unorm8);
}

TEST_CASE("Few voxels far apart make few bricks", "[brick]") {
  const ScalarGrid grid = makeVoxels(
      {{{-2'000'000'000, 5, 5}, 1.0f}, {{2'000'000'000, -2'000'000'005, 5}, 2.0f}, {{77, 5, 2'000'000'005}, 3.0f}});
  for (const int interior : {8, 32, 256}) {
    const auto bricks = brickGrid(grid, {interior, 1, true});
    CHECK(bricks->bricks.size() >= 3);
    CHECK(bricks->bricks.size() <= 24);
    CHECK(bricks->domain.extent().x == 4'000'000'003);
    CHECK(bricks->value == Range{0, 3});
    std::vector<float> voxels(bricks->layout.voxels());
    int found = 0;
    for (const Brick& brick : bricks->bricks) {
      bricks->read(brick.origin, voxels);
      found += std::find(voxels.begin(), voxels.end(), 3.0f) != voxels.end();
    }
    CHECK(found >= 1);
  }
  CHECK_THROWS_WITH(unbrickedGrid(grid), Catch::Contains("2^31"));
  CHECK_THROWS_WITH(backgroundBricks(*brickGrid(grid)), Catch::Contains("limit of 1048576"));
}

TEST_CASE("Bricks up to the last 32-bit coordinate work, and those beyond are refused by name", "[brick]") {
  // The brick is the one before the last. Its apron still has coordinates, and slabs reach the domain from
  // no brick beyond.
  const auto bricks = brickGrid(makeVoxels({{{kLargest - 34, 0, 0}, 1.0f}, {{-kLargest + 33, 0, 0}, 1.0f}}), {32});
  CHECK(bricks->domain.max.x == kLargest - 33);
  std::vector<float> voxels(bricks->layout.voxels());
  bricks->read({kLargest - 63, 0, 0}, voxels);
  CHECK(std::count(voxels.begin(), voxels.end(), 1.0f) == 1);

  CHECK_THROWS_AS(brickGrid(makeVoxels({{{0, kLargest - 5, 0}, 1.0f}}), {16}), InvalidArgument);
  CHECK_THROWS_WITH(brickGrid(makeVoxels({{{0, kLargest - 5, 0}, 1.0f}}), {16}), Catch::Contains("y = 2147483648"));
  CHECK_THROWS_WITH(brickGrid(makeVoxels({{{0, 0, kLargest}, 1.0f}})), Catch::Contains("z = 2147483648"));
  CHECK_THROWS_WITH(brickGrid(makeVoxels({{{-kLargest - 1, 0, 0}, 1.0f}})), Catch::Contains("x = -2147483649"));
}

TEST_CASE("Background bricks fill the rest of what slabs reach the domain from", "[brick]") {
  for (const int interior : {8, 16, 64}) {
    const ScalarGrid grid = makeSparse({-77, 13, 1000});
    const auto bricks = brickGrid(grid, {interior});
    const std::vector<Brick> background = backgroundBricks(*bricks);
    const auto cells = [&](int axis) {
      const IndexBox reach = bricks->reach();
      return std::floor(double(reach.max[axis]) / interior) - std::floor(double(reach.min[axis]) / interior) + 1;
    };
    CHECK(double(background.size() + bricks->bricks.size()) == cells(0) * cells(1) * cells(2));
    std::size_t doubled = 0, occupied = 0;
    std::vector<float> voxels(bricks->layout.voxels());
    for (const Brick& brick : background) {
      doubled += brickAt(*bricks, brick.origin) != nullptr;
      bricks->read(brick.origin, voxels);
      occupied += std::any_of(voxels.begin(), voxels.end(), [](float v) { return v != 0; });
    }
    CHECK(doubled == 0);
    CHECK(occupied == 0);
    CHECK_THROWS_WITH(backgroundBricks(*bricks, background.size() - 1),
                      Catch::Contains(std::to_string(background.size())));
    CHECK(backgroundBricks(*bricks, background.size()).size() == background.size());
  }
}

TEST_CASE("The grid without bricks is one brick, all that slabs reach the domain from", "[brick]") {
  const ScalarGrid grid = withTransform(makeSparse({-30, 7, 1000}, 2, 6, 90), crookedTransform());
  const auto whole = unbrickedGrid(grid, {32, 2, true});
  const auto bricks = brickGrid(grid, {16, 1, true});
  REQUIRE(whole->bricks.size() == 1);
  CHECK(whole->domain == bricks->domain);
  CHECK(whole->bricks[0].origin == whole->reach().min);
  CHECK(glm::i64vec3(whole->layout.interior) == whole->reach().extent());
  CHECK(whole->value == bricks->value);
  CHECK(whole->gradient == bricks->gradient);
  CHECK(whole->exactFormat == bricks->exactFormat);
  CHECK(backgroundBricks(*whole).empty());
  std::vector<float> values(whole->layout.voxels()), gradients(values.size());
  whole->read(whole->bricks[0].origin, values, gradients);
  CHECK(whole->bricks[0].value ==
        Range{*std::min_element(values.begin(), values.end()), *std::max_element(values.begin(), values.end())});
  CHECK(whole->bricks[0].gradient == Range{*std::min_element(gradients.begin(), gradients.end()),
                                           *std::max_element(gradients.begin(), gradients.end())});
  // The voxels are the same as through bricks.
  std::vector<float> brickValues(bricks->layout.voxels()), brickGradients(brickValues.size());
  const glm::ivec3 edge = whole->layout.edge();
  std::size_t wrong = 0, compared = 0;
  for (const Brick& brick : bricks->bricks) {
    bricks->read(brick.origin, brickValues, brickGradients);
    for (int i = 0; i < static_cast<int>(brickValues.size()); ++i) {
      const glm::ivec3 voxel = brick.origin - 1 + glm::ivec3(i % 18, i / 18 % 18, i / 324);
      const glm::ivec3 at = voxel - whole->bricks[0].origin + whole->layout.apron;
      if (glm::clamp(at, glm::ivec3(0), edge - 1) != at) continue;
      const auto there = static_cast<std::size_t>((at.z * edge.y + at.y) * edge.x + at.x);
      const auto here = static_cast<std::size_t>(i);
      wrong += values[there] != brickValues[here] || gradients[there] != brickGradients[here];
      ++compared;
    }
  }
  CHECK(compared > 0);
  CHECK(wrong == 0);
}

TEST_CASE("Options that no brick can have are refused", "[brick]") {
  const ScalarGrid grid = makeVoxels({{{0, 0, 0}, 1.0f}});
  for (const int interior : {-8, 0, 4, 12, 264}) CHECK_THROWS_AS(brickGrid(grid, {interior}), InvalidArgument);
  CHECK_THROWS_WITH(brickGrid(grid, {12}), Catch::Contains("12") && Catch::Contains("multiple of 8"));
  CHECK_THROWS_WITH(brickGrid(grid, {8, 0}), Catch::Contains("apron is 0"));
  CHECK_THROWS_WITH(brickGrid(grid, {8, 9}), Catch::Contains("apron is 9"));
  CHECK_THROWS_WITH(brickGrid(ScalarGrid{}), Catch::Contains("no grid"));
}
