// What read() gives: the voxels of the grid, in interior and apron, wherever the grid lies.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/Interpolation.h>
#include <tbb/parallel_for.h>

#include <catch2/catch.hpp>
#include <map>

#include "support/test_grids.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;

namespace {
struct NamedGrid {
  const char* name;
  ScalarGrid grid;
};

std::vector<NamedGrid> variedGrids() {
  return {{"dense", makeDense({50, 41, 33}, {-7, 3, 10})},
          {"dense, far away", makeDense({40, 20, 20}, {1'000'003, -999'999, 1'000'000})},
          {"sparse", makeSparse({-100, -90, 7})},
          {"level set", makeSphereLevelSet()},
          {"tiles", makeTiles()},
          {"tiles in a background", makeTiles(-2.5f)}};
}

std::vector<float> voxelsOf(const Bricks& bricks, const glm::ivec3& origin) {
  std::vector<float> voxels(bricks.layout.voxels());
  bricks.read(origin, voxels);
  return voxels;
}

float voxelOf(const ScalarGrid& grid, const glm::ivec3& at) {
  return grid.grid->tree().getValue(openvdb::Coord(at.x, at.y, at.z));
}

// Interpolates in a brick's array as a texture unit does.
double interpolate(const BrickLayout& layout, const glm::ivec3& origin, const std::vector<float>& voxels,
                   const glm::dvec3& point) {
  const glm::dvec3 local = point - glm::dvec3(origin - layout.apron);
  const glm::ivec3 base = glm::clamp(glm::ivec3(glm::floor(local)), glm::ivec3(0), layout.edge() - 2);
  const glm::dvec3 t = local - glm::dvec3(base);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 bit(corner & 1, corner >> 1 & 1, corner >> 2), at = base + bit;
    const glm::dvec3 weight = glm::mix(1.0 - t, t, glm::dvec3(bit));
    const glm::i64vec3 edge(layout.edge());
    sum += weight.x * weight.y * weight.z * voxels[static_cast<std::size_t>((at.z * edge.y + at.y) * edge.x + at.x)];
  }
  return sum;
}
}  // namespace

TEST_CASE("Voxels are those of the grid, x fastest", "[brick]") {
  for (const auto& [name, grid] : variedGrids()) {
    INFO(name);
    const auto bricks = brickGrid(grid, {16, 2});
    const glm::ivec3 edge = bricks->layout.edge();
    const auto step = std::max<std::size_t>(1, bricks->bricks.size() / 40);
    for (std::size_t i = 0; i < bricks->bricks.size(); i += step) {
      const glm::ivec3 first = bricks->bricks[i].origin - 2;
      const std::vector<float> voxels = voxelsOf(*bricks, bricks->bricks[i].origin);
      std::size_t at = 0, wrong = 0;
      for (int z = 0; z < edge.z; ++z)
        for (int y = 0; y < edge.y; ++y)
          for (int x = 0; x < edge.x; ++x) wrong += voxels[at++] != voxelOf(grid, first + glm::ivec3(x, y, z));
      CHECK(wrong == 0);
    }
  }
}

// Invariant 3 of the design: no seam can come from the voxels.
TEST_CASE("Apron voxels equal the neighbour's voxels", "[brick]") {
  struct Case {
    ScalarGrid grid;
    int interior, apron;
  };
  const ScalarGrid dense = withTransform(makeDense({50, 41, 33}, {-7, 3, 10}), crookedTransform());
  for (const auto& [grid, interior, apron] :
       {Case{dense, 8, 1}, Case{dense, 16, 2}, Case{dense, 24, 3}, Case{dense, 8, 8},
        Case{makeSparse(glm::ivec3(-100)), 32, 1}, Case{makeSphereLevelSet(), 16, 1}, Case{makeTiles(3), 32, 2}}) {
    INFO("interior " << interior << ", apron " << apron);
    const auto bricks = brickGrid(grid, {interior, apron, true});
    const glm::ivec3 edge = bricks->layout.edge();
    using Block = std::pair<std::vector<float>, std::vector<float>>;
    std::map<std::tuple<int, int, int>, Block> blocks;
    const auto blockOf = [&](const glm::ivec3& origin) -> const Block& {
      Block& block = blocks[{origin.x, origin.y, origin.z}];
      if (block.first.empty()) {
        block = {std::vector<float>(bricks->layout.voxels()), std::vector<float>(bricks->layout.voxels())};
        bricks->read(origin, block.first, block.second);
      }
      return block;
    };
    std::size_t compared = 0, wrongValues = 0, wrongGradients = 0;
    const auto stride = std::max<std::size_t>(1, bricks->bricks.size() / 30);
    for (std::size_t i = 0; i < bricks->bricks.size(); i += stride) {
      const glm::ivec3 origin = bricks->bricks[i].origin;
      const Block& own = blockOf(origin);
      for (int z = 0; z < edge.z; ++z)
        for (int y = 0; y < edge.y; ++y)
          for (int x = 0; x < edge.x; ++x) {
            const glm::ivec3 local = glm::ivec3(x, y, z) - apron;
            const glm::ivec3 cell(glm::floor(glm::dvec3(local) / double(interior)));
            if (cell == glm::ivec3(0)) continue;
            const Block& other = blockOf(origin + cell * interior);
            const glm::ivec3 there = local - cell * interior + apron;
            const auto a = static_cast<std::size_t>((z * edge.y + y) * edge.x + x);
            const auto b = static_cast<std::size_t>((there.z * edge.y + there.y) * edge.x + there.x);
            wrongValues += own.first[a] != other.first[b];
            wrongGradients += own.second[a] != other.second[b];
            ++compared;
          }
    }
    CHECK(compared > 0);
    CHECK(wrongValues == 0);
    CHECK(wrongGradients == 0);
  }
}

TEST_CASE("Interpolated values agree with OpenVDB's BoxSampler", "[brick]") {
  for (const auto& [name, grid] : variedGrids())
    for (const int interior : {8, 16, 32, 64}) {
      INFO(name << ", interior " << interior);
      const auto bricks = brickGrid(grid, {interior});
      const auto unbricked = unbrickedGrid(grid);
      const std::vector<float> whole = voxelsOf(*unbricked, unbricked->bricks.front().origin);
      REQUIRE(!bricks->bricks.empty());
      TestRandom random(5);
      double worst = 0, worstUnbricked = 0;
      for (int i = 0; i < 60; ++i) {
        const Brick& brick =
            bricks->bricks[static_cast<std::size_t>(random.below(static_cast<int>(bricks->bricks.size())))];
        const std::vector<float> voxels = voxelsOf(*bricks, brick.origin);
        const glm::dvec3 low = glm::dvec3(brick.origin) - 0.5, high = low + double(interior);
        for (int j = 0; j < 40; ++j) {
          glm::dvec3 p = random.point(low, high);
          // Half of the points lie on a face, an edge or a corner of the brick's space, or on a voxel.
          if (j % 2)
            for (int axis = 0; axis < 3; ++axis) {
              const int where = random.below(4);
              if (where == 0) p[axis] = low[axis];
              if (where == 1) p[axis] = high[axis];
              if (where == 2) p[axis] = std::floor(p[axis] + 0.5);
            }
          const double expected = openvdb::tools::BoxSampler::sample(grid.grid->tree(), openvdb::Vec3R(p.x, p.y, p.z));
          worst = std::max(worst, std::abs(interpolate(bricks->layout, brick.origin, voxels, p) - expected));
          const IndexBox& domain = unbricked->domain;
          if (glm::clamp(p, glm::dvec3(domain.min), glm::dvec3(domain.max)) == p)
            worstUnbricked = std::max(
                worstUnbricked,
                std::abs(interpolate(unbricked->layout, unbricked->bricks.front().origin, whole, p) - expected));
        }
      }
      // The sampler adds seven times in 32 bits, at values up to 6.
      CHECK(worst < 7 * 6 * 6e-8);
      CHECK(worstUnbricked < 7 * 6 * 6e-8);
    }
}

TEST_CASE("Every voxel that is not background is owned by exactly one brick", "[brick]") {
  for (const auto& [name, grid] : variedGrids())
    for (const int interior : {8, 24, 64}) {
      INFO(name << ", interior " << interior);
      const float background = grid.grid->background();
      std::uint64_t expected = 0;
      for (auto value = grid.grid->cbeginValueAll(); value; ++value)
        if (*value != background) expected += value.getVoxelCount();
      const auto bricks = brickGrid(grid, {interior});
      const glm::ivec3 edge = bricks->layout.edge();
      std::uint64_t owned = 0;
      for (const Brick& brick : bricks->bricks) {
        CHECK(brick.origin % interior == glm::ivec3(0));
        const std::vector<float> voxels = voxelsOf(*bricks, brick.origin);
        for (int z = 1; z + 1 < edge.z; ++z)
          for (int y = 1; y + 1 < edge.y; ++y)
            for (int x = 1; x + 1 < edge.x; ++x)
              owned += voxels[static_cast<std::size_t>((z * edge.y + y) * edge.x + x)] != background;
      }
      CHECK(owned == expected);
      const auto before = [](const Brick& a, const Brick& b) {
        return std::tie(a.origin.z, a.origin.y, a.origin.x) < std::tie(b.origin.z, b.origin.y, b.origin.x);
      };
      CHECK(std::is_sorted(bricks->bricks.begin(), bricks->bricks.end(), before));
      CHECK(std::adjacent_find(bricks->bricks.begin(), bricks->bricks.end(), [](const Brick& a, const Brick& b) {
              return a.origin == b.origin;
            }) == bricks->bricks.end());
    }
}

TEST_CASE("A voxel that is not finite reads as background and is counted while active", "[brick]") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const openvdb::FloatGrid::Ptr grid = makeDense({20, 20, 20}).grid->deepCopy();
  grid->tree().setValue(openvdb::Coord(3, 4, 5), nan);
  grid->tree().setValue(openvdb::Coord(7, 8, 9), -inf);
  grid->tree().setValueOff(openvdb::Coord(11, 4, 5), inf);
  grid->tree().addTile(1, openvdb::Coord(64, 0, 0), nan, true);
  const auto bricks = brickGrid(makeGrid(grid), {8, 1, true});
  CHECK(bricks->nonFiniteVoxels == 2 + 512);
  CHECK(bricks->value.min == 0);
  CHECK(bricks->value.max < 1);
  CHECK(bricks->domain.max.x == 72);  // the tile is active, so it is part of the domain
  std::vector<float> voxels(bricks->layout.voxels()), gradients(voxels.size());
  for (const Brick& brick : bricks->bricks) {
    bricks->read(brick.origin, voxels, gradients);
    const auto finite = [](float v) { return std::isfinite(v); };
    CHECK(std::all_of(voxels.begin(), voxels.end(), finite));
    CHECK(std::all_of(gradients.begin(), gradients.end(), finite));
    CHECK(brick.origin.x < 64);
  }
  bricks->read({0, 0, 0}, voxels);
  CHECK(voxels[(6 * 10 + 5) * 10 + 4] == 0);  // (3, 4, 5), beyond an apron of 1
  CHECK(voxels[(6 * 10 + 5) * 10 + 5] != 0);
}

TEST_CASE("A background that is not finite reads as zero", "[brick]") {
  const auto bricks = brickGrid(makeVoxels({{{1, 2, 3}, 5.0f}}, std::numeric_limits<float>::infinity()));
  CHECK(bricks->background == 0);
  CHECK(bricks->nonFiniteVoxels == 0);
  CHECK(bricks->value == Range{0, 5});
  CHECK(voxelsOf(*bricks, {0, 0, 0})[0] == 0);
}

TEST_CASE("Bricks may be read from several threads", "[brick]") {
  const auto bricks = brickGrid(makeSparse(), {16, 1, true});
  const std::size_t voxels = bricks->layout.voxels();
  std::vector<int> same(bricks->bricks.size());
  tbb::parallel_for(std::size_t(0), same.size(), [&](std::size_t i) {
    std::vector<float> values(voxels), gradients(voxels), plain(voxels);
    bricks->read(bricks->bricks[i].origin, values, gradients);
    bricks->read(bricks->bricks[i].origin, plain);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const auto [flat, steep] = std::minmax_element(gradients.begin(), gradients.end());
    same[i] = values == plain && bricks->bricks[i].value == Range{*low, *high} &&
              bricks->bricks[i].gradient == Range{*flat, *steep};
  });
  CHECK(std::count(same.begin(), same.end(), 0) == 0);
}

TEST_CASE("Cells without a brick read as background", "[brick]") {
  const auto bricks = brickGrid(makeVoxels({{{1, 2, 3}, 5.0f}}, -1.0f), {16});
  const std::vector<float> voxels = voxelsOf(*bricks, {-1600, 320, 16});
  CHECK(std::count(voxels.begin(), voxels.end(), -1.0f) == static_cast<std::ptrdiff_t>(voxels.size()));
}

TEST_CASE("Spans of the wrong size and cells beyond 32 bits are refused", "[brick]") {
  const auto bricks = brickGrid(makeDense({10, 10, 10}), {8});
  std::vector<float> voxels(bricks->layout.voxels()), more(voxels.size() + 1);
  CHECK_THROWS_WITH(bricks->read({0, 0, 0}, more), Catch::Contains("1001") && Catch::Contains("1000"));
  CHECK_THROWS_WITH(bricks->read({0, 0, 0}, voxels, voxels), Catch::Contains("without gradients"));
  CHECK_THROWS_AS(bricks->read({0, 0, 0}, voxels, voxels), InvalidArgument);
  CHECK_THROWS_WITH(bricks->read({2147483640, 0, 0}, voxels), Catch::Contains("x = 2147483648"));
  const auto steep = brickGrid(makeDense({10, 10, 10}), {8, 1, true});
  CHECK_THROWS_AS(steep->read({0, 0, 0}, voxels, more), InvalidArgument);
}
