// Rows of numbers out of bricks: against interpolation in the whole field.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_rows.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/field_bricks.h"
#include "support/test_grids.h"

using namespace umbrick;

namespace {

// A ball of whole numbers: bricks in its corners hold nothing that the function shows.
double ball(const glm::ivec3& i) {
  return std::round(std::max(0.0, 200 - 20 * glm::length(glm::dvec3(i) - glm::dvec3(20, 23, 26))));
}

FieldBricks ballBricks(int apron) {
  FieldOptions options;
  options.interior = 8;
  options.apron = apron;
  FieldBricks bricks(ball, {glm::ivec3(0), glm::ivec3(47)}, options);
  bricks.exactFormat = VoxelFormat::unorm8;
  return bricks;
}

double interpolated(const glm::dvec3& at) {
  const glm::ivec3 whole(glm::floor(at));
  const glm::dvec3 share = at - glm::dvec3(whole);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= offset[axis] ? share[axis] : 1 - share[axis];
    if (weight > 0) sum += weight * ball(whole + offset);
  }
  return sum;
}

RayLattice latticeAlong(int n) {
  RayLattice lattice;
  lattice.n = n;
  lattice.u = n == 0 ? 1 : 0;
  lattice.v = n == 2 ? 1 : 2;
  return lattice;
}

}  // namespace

TEST_CASE("Rows along each axis are those of the field, also beside bricks that are not held", "[sweep]") {
  const TransferFunction transfer({{60, {glm::dvec3(1), 0}}, {200, {glm::dvec3(1), 1}}});
  const MediumTable table(transfer, 0, 1e9);
  for (const int apron : {1, 3}) {
    const FieldBricks bricks = ballBricks(apron);
    BrickVoxels voxels(bricks);
    voxels.hold(voxels.visible(table, true, false), table, true);
    REQUIRE(voxels.bricks().size() > 10);
    REQUIRE(voxels.bricks().size() < bricks.bricks.size());
    TestRandom random(5);
    for (int n = 0; n < 3; ++n) {
      const RayLattice lattice = latticeAlong(n);
      const BrickRows rows(voxels, lattice);
      RowReader reader(voxels, rows, lattice, table, 0, 1);
      int visible = 0;
      for (int trial = 0; trial < 400; ++trial) {
        const double v = trial % 3 ? random.uniform(4, 44) : 4 + random.below(40);
        const double s = trial % 2 ? random.uniform(4, 44) : 4 + random.below(40);
        const std::int64_t begin = 4 + random.below(30), end = begin + 2 + random.below(14);
        reader.read(v, s, begin, end);
        // Wherever the function shows something, or next to that, rows are exact.
        for (std::int64_t u = begin; u + 1 < end; ++u) {
          glm::dvec3 at;
          at[lattice.u] = static_cast<double>(u);
          at[lattice.v] = v;
          at[lattice.n] = s;
          glm::dvec3 next = at;
          next[lattice.u] += 1;
          const double here = interpolated(at), there = interpolated(next);
          if (std::max(here, there) <= 60) continue;
          ++visible;
          CAPTURE(apron, n, v, s, u);
          CHECK(reader.row(0)[u - begin] == Approx(table.stepsOf(here)).margin(1e-2));
          CHECK(reader.row(0)[u - begin + 1] == Approx(table.stepsOf(there)).margin(1e-2));
        }
      }
      CHECK(visible > 70);
    }
  }
}

TEST_CASE("Cells that show something are active", "[sweep]") {
  const TransferFunction transfer({{60, {glm::dvec3(1), 0}}, {200, {glm::dvec3(1), 1}}});
  const MediumTable table(transfer, 0, 1e9);
  const FieldBricks bricks = ballBricks(1);
  BrickVoxels voxels(bricks);
  voxels.hold(voxels.visible(table, true, false), table, true);
  for (int n = 0; n < 3; ++n) {
    const RayLattice lattice = latticeAlong(n);
    const BrickRows rows(voxels, lattice);
    std::int64_t active = 0;
    for (int s = -1; s < 48; ++s)
      for (int v = -1; v < 48; ++v) {
        const auto cells = rows.activeCells(v, s);
        for (std::size_t i = 0; i < cells.size(); ++i) {
          CHECK(cells[i].begin < cells[i].end);
          if (i > 0) CHECK(cells[i].begin > cells[i - 1].end);
          active += cells[i].end - cells[i].begin;
        }
        for (int u = 0; u < 47; ++u) {
          double most = 0;
          for (int corner = 0; corner < 8; ++corner) {
            glm::ivec3 at;
            at[lattice.u] = u + (corner & 1);
            at[lattice.v] = v + (corner >> 1 & 1);
            at[lattice.n] = s + (corner >> 2);
            most = std::max(most, ball(at));
          }
          if (most <= 60) continue;
          CAPTURE(n, s, v, u);
          CHECK(std::any_of(cells.begin(), cells.end(),
                            [&](const auto& part) { return part.begin <= u && u < part.end; }));
        }
      }
    // A ball of radius 7 has 1437 cells; groups of four add a rim.
    CHECK(active > 1400);
    CHECK(active < 8000);
  }
}

TEST_CASE("Bricks that stay visible are read once, and those that leave make room", "[sweep]") {
  const FieldBricks bricks = ballBricks(1);
  BrickVoxels voxels(bricks);
  const MediumTable wide(TransferFunction({{20, {glm::dvec3(1), 0}}, {200, {glm::dvec3(1), 1}}}), 0, 1e9);
  const MediumTable narrow(TransferFunction({{150, {glm::dvec3(1), 0}}, {200, {glm::dvec3(1), 1}}}), 0, 1e9);
  voxels.hold(voxels.visible(narrow, true, false), narrow, true);
  const std::uint64_t few = voxels.loaded();
  CHECK(few == voxels.bricks().size());
  const std::uint64_t bytes = voxels.bytes();
  voxels.hold(voxels.visible(wide, true, false), wide, true);
  CHECK(voxels.loaded() == voxels.bricks().size() - few);
  CHECK(voxels.bytes() > bytes);
  voxels.hold(voxels.visible(narrow, true, false), narrow, true);
  CHECK(voxels.loaded() == 0);
  CHECK(voxels.bytes() == bytes);
  // Voxels are one byte each, as the whole numbers of the field are.
  CHECK(voxels.code() == VoxelCode::u8);
  CHECK(bytes < few * 1.15 * 1000);
  CHECK(voxels.bytesOf(voxels.visible(narrow, true, false), narrow.is2d()) == few * 1000);
}
