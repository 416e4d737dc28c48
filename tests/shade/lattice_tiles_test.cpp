// Compares lists of tiles with a look at every texel of the lattice.
// SPDX-License-Identifier: Apache-2.0
#include "shade/lattice_tiles.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <utility>

#include "shade/constants.h"

using namespace umbrick;

namespace {

using Tile = std::pair<int, int>;

// Slices of rectangles in texels. Each is a polygon of its own, seen in a parallel view whose image is the lattice.
struct Drawn {
  explicit Drawn(const glm::ivec2& size) {
    light.lattice.size = size;
    view.projection = Projection::orthographic;
    view.halfExtent = 0.5 * glm::dvec2(size);
    view.size = size;
    light.view = view;
    // The view's centre is the first texel's corner, as the centre of the eye's view is.
    light.lattice.first = -size / 2;
  }
  static void addSlice(ProxySlices& slices, const std::vector<Rectangle>& rectangles, const glm::dvec2& halfExtent,
                       const glm::dvec2& centre) {
    for (const Rectangle& r : rectangles) {
      slices.polygons.push_back({0, static_cast<std::int32_t>(slices.vertices.size()), 4});
      for (const glm::dvec2& corner : {r.min, glm::dvec2(r.max.x, r.min.y), r.max, glm::dvec2(r.min.x, r.max.y)})
        slices.vertices.emplace_back((corner - centre) / halfExtent);
    }
    slices.start.push_back(static_cast<std::int32_t>(slices.polygons.size()));
  }
  void add(const std::vector<Rectangle>& seen, const std::vector<Rectangle>& occluding) {
    addSlice(eye, seen, view.halfExtent, glm::dvec2(0));
    addSlice(light.slices, occluding, view.halfExtent, light.lattice.centre());
    light.extents.depths.push_back(static_cast<double>(light.extents.depths.size()) + 0.5);
    Rectangle allSeen, allOccluding;
    for (const Rectangle& r : seen) allSeen.include(r);
    for (const Rectangle& r : occluding) allOccluding.include(r);
    light.extents.seen.push_back(allSeen);
    light.extents.occluding.push_back(allOccluding);
  }
  LatticeTiles tiles() const { return latticeTiles(light, {view, eye, {}, glm::ivec3(8), {}, {}}); }

  IndexView view;
  ProxySlices eye;
  LightGeometry light;
};

std::set<Tile> tilesOf(const LatticeTiles& tiles, std::int64_t first, std::int64_t last) {
  std::set<Tile> found;
  for (const std::uint32_t place : tiles.of(first, last))
    found.insert({static_cast<int>(place & ((1u << kTileRowShift) - 1)), static_cast<int>(place >> kTileRowShift)});
  return found;
}

}  // namespace

TEST_CASE("Tiles are those that hold something seen, with its neighbours, or something occluding", "[shade]") {
  Drawn drawn({64, 48});                                      // 8 x 6 tiles, texels from (-32, -24)
  drawn.add({{{-31, -23}, {-30, -22}}}, {});                  // inside the first tile
  drawn.add({{{-24.5, -20}, {-24.4, -19}}}, {});              // its neighbours lie in the second tile
  drawn.add({}, {{{-24.5, -20}, {-24.4, -19}}});              // an occluder is marked without neighbours
  drawn.add({}, {});                                          // nothing
  drawn.add({{{20, 10}, {21, 11}}}, {{{-31, 0}, {-15, 9}}});  // both, apart from each other
  const LatticeTiles tiles = drawn.tiles();
  REQUIRE(tiles.start.size() == 6);
  CHECK(tilesOf(tiles, 0, 0) == std::set<Tile>{{0, 0}});
  CHECK(tilesOf(tiles, 1, 1) == std::set<Tile>{{0, 0}, {1, 0}});
  CHECK(tilesOf(tiles, 2, 2) == std::set<Tile>{{0, 0}});
  CHECK(tilesOf(tiles, 3, 3).empty());
  CHECK(tilesOf(tiles, 4, 4) == std::set<Tile>{{6, 4}, {0, 3}, {1, 3}, {2, 3}, {0, 4}, {1, 4}, {2, 4}});
  CHECK(tiles.of(0, 4).size() == tiles.places.size());
  CHECK(tiles.of(1, 2).size() == 3);
}

TEST_CASE("What is seen or occludes beyond the lattice marks no tile", "[shade]") {
  Drawn drawn({20, 12});  // 3 x 2 tiles, the last of them cut
  drawn.add({{{-10, -6}, {10, 6}}}, {{{-10, -6}, {10, 6}}});
  drawn.light.extents.occluding[0] = {{-10, -6}, {-9, -5}};
  const LatticeTiles tiles = drawn.tiles();
  const std::set<Tile> all{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
  CHECK(tilesOf(tiles, 0, 0) == all);
  CHECK(tiles.places.size() == all.size());  // each tile stands there once
  // Light reaches only a part of an occluder.
  drawn = Drawn({20, 12});
  drawn.add({}, {{{-10, -6}, {10, 6}}});
  drawn.light.extents.occluding[0] = {{-10, -6}, {-9, -5}};
  CHECK(tilesOf(drawn.tiles(), 0, 0) == std::set<Tile>{{0, 0}});
}
