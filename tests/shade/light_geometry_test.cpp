// Tests the lattice of the light and what lies on it, without a context.
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_geometry.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "shade/random_light.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

// A block of bricks of 8 voxels, and slices through it as a camera sees them.
struct Block {
  explicit Block(Projection projection) {
    camera.eye = {20, 6, 60};
    camera.lookAt = {16, 16, 16};
    camera.projection = projection;
    camera.fov = 1.2;
    camera.viewHeight = 60;
    camera.width = camera.height = 64;
    view = indexView(camera, glm::dmat4(1));
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
          if ((x + y + z) % 3 != 0) bricks.push_back(8 * glm::ivec3(x, y, z));
    slices = cutSlices(view, bricks, glm::ivec3(8), bounds, 0.9);
  }
  LitVolume volume() const { return {view, slices, bricks, glm::ivec3(8), bounds, bounds}; }
  Camera camera;
  IndexView view;
  std::vector<glm::ivec3> bricks;
  std::vector<glm::dvec4> bounds{{0.1, 0.2, -1, 70}};
  ProxySlices slices;
};

LightPaths coneOfThree() {
  LightPaths paths;
  for (const double phi : {0.4, 2.4, 4.4})
    paths.lights.push_back(lightSlope(glm::normalize(glm::dvec3(std::cos(phi), std::sin(phi), 0.8))));
  return paths;
}

bool holds(const Rectangle& outer, const Rectangle& inner, double tolerance) {
  return inner.empty() || (glm::all(glm::greaterThanEqual(inner.min, outer.min - tolerance)) &&
                           glm::all(glm::lessThanEqual(inner.max, outer.max + tolerance)));
}

}  // namespace

TEST_CASE("Rectangles are empty, joined, cut, grown and moved as sets of points", "[shade]") {
  const Rectangle none, a{{0, 0}, {2, 3}}, b{{1, -1}, {4, 1}};
  CHECK(none.empty());
  CHECK(none.grown(5).empty());
  CHECK(none.moved({1, 2}).empty());
  CHECK(none.within(a).empty());
  Rectangle joined = none;
  joined.include(none);
  CHECK(joined.empty());
  joined.include(a);
  joined.include(b);
  CHECK(joined.min == glm::dvec2(0, -1));
  CHECK(joined.max == glm::dvec2(4, 3));
  joined.include(glm::dvec2(7, -2));
  CHECK(joined.min == glm::dvec2(0, -2));
  CHECK(joined.max == glm::dvec2(7, 3));
  CHECK(a.within(b).min == glm::dvec2(1, 0));
  CHECK(a.within(b).max == glm::dvec2(2, 1));
  CHECK(a.within(Rectangle{{3, 0}, {4, 1}}).empty());
  CHECK(a.grown(0.5).min == glm::dvec2(-0.5));
  CHECK(a.moved({1, -1}).max == glm::dvec2(3, 2));
}

TEST_CASE("The needed region of a slice holds every path to what is seen behind it, and no more", "[shade]") {
  TestRandom random(11);
  for (int round = 0; round < 100; ++round) {
    const LightExtents extents = randomExtents(random);
    const LightPaths paths = randomPaths(random);
    const std::vector<Rectangle> needed = neededRegions(extents, paths);
    REQUIRE(needed.size() == extents.depths.size());
    for (std::size_t j = 0; j < needed.size(); ++j) {
      Rectangle hull;
      for (const LightSlope& light : slopesOf(paths))
        for (std::size_t i = j; i < needed.size(); ++i)
          hull.include(extents.seen[i].moved((extents.depths[i] - extents.depths[j]) / extents.texel * light.slope));
      INFO("round " << round << ", slice " << j);
      REQUIRE(needed[j].empty() == hull.empty());
      if (hull.empty()) continue;
      // Sums of steep slopes reach some 1e5 texels in double precision.
      CHECK(glm::length(needed[j].min - hull.min) < 1e-9);
      CHECK(glm::length(needed[j].max - hull.max) < 1e-9);
    }
  }
}

TEST_CASE("Texels are as asked for, or as large as the largest of slab, voxel and a share of the diagonal", "[shade]") {
  CHECK(latticeTexel(2, 3, 0.5, 100) == 0.25);
  CHECK(latticeTexel(0, 3, 0.5, 100) == 3);
  CHECK(latticeTexel(0, 0.1, 0.5, 100) == 0.5);
  CHECK(latticeTexel(0, 0.1, 0.5, 4096) == 2);  // 2048 texels along the diagonal
}

TEST_CASE("The view of a lattice sees points where the lattice has them, straight along the view axis", "[shade]") {
  TestRandom random(21);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const Block block(projection);
    LightLattice lattice;
    lattice.texel = 0.7;
    lattice.shift = {0.2, 0.6};
    lattice.first = {-9, 4};
    lattice.size = {40, 30};
    const IndexView view = latticeView(block.view, lattice);
    CHECK(view.projection == Projection::orthographic);
    CHECK(view.size == lattice.size);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 index = random.point(glm::dvec3(0), glm::dvec3(32));
      const glm::dvec3 seen = block.view.toView(index), onLattice = view.toView(index);
      CHECK(onLattice.z == seen.z);
      // Device coordinates are in [-1, 1] across the lattice, which gives texels from its first one.
      const glm::dvec2 device = glm::dvec2(onLattice) / view.halfExtent;
      const glm::dvec2 texel = 0.5 * (device + 1.0) * glm::dvec2(lattice.size) + glm::dvec2(lattice.first);
      CHECK(glm::length(texel - (glm::dvec2(seen) / lattice.texel - lattice.shift)) < 1e-11);
      // The matrices toIndex and eyeIndex lead back to the same point.
      const glm::dvec3 back =
          view.eyeIndex + onLattice.x * view.toIndex[0] + onLattice.y * view.toIndex[1] + onLattice.z * view.toIndex[2];
      CHECK(glm::length(back - index) < 1e-11);
    }
  }
}

TEST_CASE("The lattice holds all that is seen, and what can occlude it", "[shade]") {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const Block block(projection);
    const LitVolume volume = block.volume();
    const LightPaths paths = coneOfThree();
    const glm::dvec2 shift(0.25, 0.75);
    const LightGeometry light = lightGeometry(volume, paths, 0.8, shift, 4096);
    REQUIRE(light.slices.count() == block.slices.count());
    REQUIRE(light.slices.first == block.slices.first);
    CHECK(light.lattice.shift == shift);
    const Rectangle whole{glm::dvec2(light.lattice.first), glm::dvec2(light.lattice.first + light.lattice.size)};
    const std::vector<Rectangle> needed = neededRegions(light.extents, paths);
    int seen = 0;
    for (std::size_t i = 0; i < light.extents.depths.size(); ++i) {
      INFO("slice " << i);
      CHECK(light.extents.depths[i] == block.slices.depth(static_cast<std::int64_t>(i)));
      // Polygons reach up to 1/64 of a pixel beyond a plane that cuts them.
      CHECK(holds(whole, light.extents.seen[i], 0));
      CHECK(holds(whole, light.extents.occluding[i], 0));
      CHECK(holds(needed[i].grown(2), light.extents.occluding[i], 0));
      seen += !light.extents.seen[i].empty();
      // The whole block is in the picture, so that whatever is seen occludes as well. Vertices lie on the grids of the
      // rasterisers, 1/256 of a pixel or of a texel.
      CHECK(holds(light.extents.occluding[i], light.extents.seen[i], 0.05));
    }
    CHECK(seen > 20);
  }
}

TEST_CASE("Planes cut the same half-space in the view of the lattice", "[shade]") {
  TestRandom random(22);
  const Block block(Projection::perspective);
  const LightGeometry light = lightGeometry(block.volume(), coneOfThree(), 0.8, glm::dvec2(0), 4096);
  REQUIRE(light.planes.size() == block.bounds.size());
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 index = random.point(glm::dvec3(0), glm::dvec3(32));
    const double eye = glm::dot(block.bounds[0], glm::dvec4(block.view.toView(index), 1));
    CHECK(glm::dot(light.planes[0], glm::dvec4(light.view.toView(index), 1)) == Approx(eye).margin(1e-11));
  }
}

TEST_CASE("A lattice larger than the driver takes is refused, one of nothing is a single texel", "[shade]") {
  const Block block(Projection::orthographic);
  CHECK_THROWS_AS(lightGeometry(block.volume(), coneOfThree(), 1e-3, glm::dvec2(0), 4096), InvalidArgument);
  CHECK_THROWS_WITH(lightGeometry(block.volume(), coneOfThree(), 1e-3, glm::dvec2(0), 4096),
                    Catch::Contains("occlusion.scale") && Catch::Contains("4096"));
  const std::vector<glm::ivec3> none;
  const ProxySlices noSlices = cutSlices(block.view, none, glm::ivec3(8), {}, 0.9);
  const LightGeometry empty =
      lightGeometry({block.view, noSlices, none, glm::ivec3(8), {}, {}}, coneOfThree(), 0.8, glm::dvec2(0), 4096);
  CHECK(empty.lattice.size == glm::ivec2(1));
  CHECK(empty.extents.depths.empty());
}
