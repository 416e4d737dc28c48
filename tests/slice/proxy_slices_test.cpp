// SPDX-License-Identifier: Apache-2.0
#include "umbrick/slice/proxy_slices.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/slice/stack_slices.h"

using namespace umbrick;

namespace {

std::vector<glm::ivec3> lattice(const glm::ivec3& cells, int interior, const glm::ivec3& first) {
  std::vector<glm::ivec3> origins;
  for (int z = 0; z < cells.z; ++z)
    for (int y = 0; y < cells.y; ++y)
      for (int x = 0; x < cells.x; ++x) origins.push_back((first + glm::ivec3(x, y, z)) * interior);
  return origins;
}

struct NamedCamera {
  std::string name;
  Camera camera;
};

// Cameras outside and inside of a lattice whose box in the world is `bounds`.
std::vector<NamedCamera> cameras(const Box& bounds) {
  std::vector<NamedCamera> all;
  Camera orthographic;
  orthographic.projection = Projection::orthographic;
  all.push_back({"face-on", orbitCamera(bounds, 0, 0)});
  all.push_back({"diagonal", orbitCamera(bounds, 0.7, 0.6)});
  all.push_back({"orthographic face-on", orbitCamera(bounds, 0, 0, orthographic)});
  all.push_back({"orthographic diagonal", orbitCamera(bounds, 0.7853981633974483, 0.6154797086703874, orthographic)});
  Camera inside;
  inside.eye = bounds.centre() + glm::dvec3(0.3, 0.1, -0.2);
  inside.lookAt = inside.eye + glm::dvec3(1, 2, 0.5);
  inside.up = {0, 0, 1};
  inside.fov = 1.5;
  all.push_back({"inside", inside});
  return all;
}

double area(const ProxySlices& slices, const ProxyPolygon& polygon) {
  double twice = 0;
  for (int i = 0; i < polygon.vertices; ++i) {
    const glm::dvec2 a(slices.vertices[static_cast<std::size_t>(polygon.firstVertex + i)]);
    const glm::dvec2 b(slices.vertices[static_cast<std::size_t>(polygon.firstVertex + (i + 1) % polygon.vertices)]);
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * std::abs(twice);
}

using Cut = std::function<ProxySlices(const std::vector<glm::ivec3>& origins, const glm::ivec3& interior)>;

// The polygons of one slice tile the cut of the whole box: the areas are the same, and every inner edge has exactly one
// twin with the same two vertices, to the bit.
// @param areas  whether the image holds all of them
void checkTiles(const Cut& cut, const glm::ivec3& cells, int interior, const glm::ivec3& first, bool areas) {
  const ProxySlices slices = cut(lattice(cells, interior, first), glm::ivec3(interior));
  const ProxySlices whole = cut({first * interior}, cells * interior);
  REQUIRE(slices.count() > 10);
  double worst = 0;
  std::size_t oddEdges = 0;
  for (std::int64_t i = 0; i < slices.count(); ++i) {
    using Point = std::pair<float, float>;
    std::map<std::pair<Point, Point>, int> edges;
    double sum = 0;
    for (int p = slices.start[static_cast<std::size_t>(i)]; p < slices.start[static_cast<std::size_t>(i) + 1]; ++p) {
      const ProxyPolygon& polygon = slices.polygons[static_cast<std::size_t>(p)];
      sum += area(slices, polygon);
      for (int v = 0; v < polygon.vertices; ++v) {
        const glm::vec2 a = slices.vertices[static_cast<std::size_t>(polygon.firstVertex + v)];
        const glm::vec2 b = slices.vertices[static_cast<std::size_t>(polygon.firstVertex + (v + 1) % polygon.vertices)];
        const Point pa{a.x, a.y}, pb{b.x, b.y};
        if (pa != pb) ++edges[std::minmax(pa, pb)];
      }
    }
    for (const auto& edge : edges) oddEdges += edge.second > 2;
    const std::int64_t j = i + slices.first - whole.first;
    double expected = 0;
    if (j >= 0 && j < whole.count())
      for (int p = whole.start[static_cast<std::size_t>(j)]; p < whole.start[static_cast<std::size_t>(j) + 1]; ++p)
        expected += area(whole, whole.polygons[static_cast<std::size_t>(p)]);
    if (areas) worst = std::max(worst, std::abs(sum - expected));
  }
  CHECK(oddEdges == 0);
  // Vertices are rounded to float: 6e-8 of coordinates of order 1, for some 100 vertices.
  CHECK(worst < 1e-5);
}

}  // namespace

TEST_CASE("Polygons of a slice tile the cut of the volume without gap or overlap", "[slice]") {
  const int interior = 8;
  const glm::ivec3 cells(3, 4, 2);
  for (const glm::ivec3 first : {glm::ivec3(0), glm::ivec3(-2, -1, 3), glm::ivec3(125'000, -125'000, 7)}) {
    glm::dmat4 transform = glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(1, 2, 3));
    for (const bool rotated : {false, true}) {
      if (!rotated) transform = glm::dmat4(1);
      Box bounds;
      for (unsigned c = 0; c < 8; ++c) {
        const glm::dvec3 corner = glm::dvec3(first * interior) - 0.5 +
                                  glm::dvec3(cells * interior) * glm::dvec3(c & 1, c >> 1 & 1, c >> 2 & 1);
        bounds.include(glm::dvec3(transform * glm::dvec4(corner, 1)));
      }
      for (const auto& [name, camera] : cameras(bounds)) {
        INFO(name << ", first cell " << first.x << ' ' << first.y << ' ' << first.z << ", rotated " << rotated);
        Camera wide = camera;                // sees everything, so that no polygon is left out
        wide.width = wide.height = 1 << 16;  // a fine grid, so that areas are not rounded by it
        const IndexView view = indexView(wide, transform);
        checkTiles([&](const auto& origins, const glm::ivec3& edge) { return cutSlices(view, origins, edge, {}, 0.5); },
                   cells, interior, first, name != "inside");
        for (const double spacing : {0.5, 0.0})
          for (const StackAim& aim : aimStacks(view, spacing)) {
            INFO("stack " << aim.axis << ", " << aim.sign << ", spacing " << spacing);
            if (name == "inside" && (aim.axis == 2 || spacing == 0)) continue;  // of a few slices, or a corner of them
            checkTiles(
                [&](const auto& origins, const glm::ivec3& edge) { return cutStack(view, aim, origins, edge, {}); },
                cells, interior, first, name != "inside");
          }
      }
    }
  }
}

// Each ray of a view has one stack, which it meets no less often than the voxels' own slices at 55 degrees.
TEST_CASE("Every ray runs along the axis of one stack", "[slice]") {
  for (const double fov : {0.3, 1.5, 2.6})
    for (const double angle : {0.0, 0.4, 0.785, 2.0, 4.0}) {
      Camera camera;
      camera.eye = {1, 2, 3};
      camera.lookAt = camera.eye + glm::dvec3(std::cos(angle), std::sin(angle), 0.3);
      camera.up = {0, 0, 1};
      camera.fov = fov;
      const IndexView view = indexView(camera, glm::rotate(glm::dmat4(1), 0.2, glm::dvec3(1, 0, 2)));
      const std::vector<StackAim> stacks = aimStacks(view, 1);
      CHECK(stacks.size() <= 6);
      for (const StackAim& aim : stacks) CHECK(aim.alone == (stacks.size() == 1));
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
          const glm::dvec2 p = view.halfExtent * (glm::dvec2(x + 0.5, y + 0.5) / 20.0 - 1.0);
          const glm::dvec3 along = p.x * view.toIndex[0] + p.y * view.toIndex[1] + view.toIndex[2];
          int found = 0;
          for (const StackAim& aim : stacks) {
            const double rate = glm::dot(aim.rate, glm::dvec3(p, 1));
            CHECK(rate == Approx(aim.sign * along[aim.axis]).margin(1e-12));
            bool main = rate > 0;
            for (int axis = 0; axis < 3; ++axis) main = main && rate >= std::abs(along[axis]) - 1e-12;
            if (!main) continue;
            ++found;
            CHECK(rate / glm::length(along) > 0.577);
          }
          CHECK(found >= 1);
        }
    }
}

TEST_CASE("A slice that coincides with a face belongs to one of the two bricks", "[slice]") {
  // An orthographic camera looks along +y at faces at y = -0.5, 7.5 and 15.5. One slice has its middle exactly at 7.5.
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.eye = {4, -1, 4};
  camera.lookAt = {4, 0, 4};
  camera.up = {0, 0, 1};
  camera.viewHeight = 20;
  const IndexView view = indexView(camera, glm::dmat4(1));
  const std::vector<glm::ivec3> origins{{0, 0, 0}, {0, 8, 0}};
  const ProxySlices slices = cutSlices(view, origins, glm::ivec3(8), {}, 1.0);
  std::map<double, int> polygonsAt;
  for (std::int64_t i = 0; i < slices.count(); ++i)
    polygonsAt[slices.depth(i) - 1] =
        slices.start[static_cast<std::size_t>(i) + 1] - slices.start[static_cast<std::size_t>(i)];
  REQUIRE(polygonsAt.count(7.5) == 1);
  CHECK(polygonsAt[7.5] == 1);
  CHECK(polygonsAt[15.5] == 1);
  CHECK(polygonsAt.count(-0.5) == 0);  // the near face is the end of a half-open interval
  CHECK(polygonsAt.size() == 16);      // as many as the two bricks are deep
}

TEST_CASE("Planes cut polygons with half a slab to spare", "[slice]") {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.eye = {4, -10, 4};
  camera.lookAt = {4, 0, 4};
  camera.up = {0, 0, 1};
  camera.viewHeight = 20;
  const IndexView view = indexView(camera, glm::dmat4(1));
  const std::vector<glm::ivec3> origins{{0, 0, 0}};
  const auto slicesKept = [&](const glm::dvec4& worldPlane) {
    const std::vector<glm::dvec4> planes{planeInView(worldPlane, camera)};
    const ProxySlices slices = cutSlices(view, origins, glm::ivec3(8), planes, 0.5);
    int kept = 0;
    for (std::int64_t i = 0; i < slices.count(); ++i)
      kept += slices.start[static_cast<std::size_t>(i) + 1] > slices.start[static_cast<std::size_t>(i)];
    return kept;
  };
  CHECK(slicesKept({0, 1, 0, 100}) == 16);
  CHECK(slicesKept({0, 1, 0, -3.6}) == 8);  // y >= 3.6 of [-0.5, 7.5]: the plane cuts the slab [3.5, 4], which stays
  CHECK(slicesKept({0, -1, 0, 3.6}) == 9);  // y <= 3.6: the plane cuts the slab [3.5, 4], which stays
  CHECK(slicesKept({0, 1, 0, -100}) == 0);
}

TEST_CASE("Slices through a camera inside the volume start at the eye", "[slice]") {
  Camera camera;
  camera.eye = {4, 4, 4};
  camera.lookAt = {4, 5, 4};
  camera.up = {0, 0, 1};
  const IndexView view = indexView(camera, glm::dmat4(1));
  const ProxySlices slices = cutSlices(view, std::vector{glm::ivec3(0)}, glm::ivec3(8), {}, 0.25);
  CHECK(slices.first == 0);
  CHECK(slices.count() == 14);  // depths from 0 to 3.5
}

// The slabs around the slices follow each other without gap, so all that has to be drawn are those whose middle is in
// the volume.
TEST_CASE("A phase moves every slice by its share of the spacing and leaves none out", "[slice]") {
  const std::vector<glm::ivec3> origins{{0, 0, 0}, {0, 8, 0}};
  const Box bounds{glm::dvec3(-0.5), {7.5, 15.5, 7.5}};
  for (const auto& [name, camera] : cameras(bounds)) {
    const IndexView view = indexView(camera, glm::dmat4(1));
    double nearest = 1e30, farthest = 0;
    for (unsigned c = 0; c < 8; ++c) {
      const glm::dvec3 corner = glm::mix(bounds.min, bounds.max, glm::dvec3(c & 1, c >> 1 & 1, c >> 2 & 1));
      nearest = std::min(nearest, view.toView(corner).z);
      farthest = std::max(farthest, view.toView(corner).z);
    }
    nearest = std::max(nearest, 0.0);
    for (const double d : {0.3, 1.0, 2.7})
      for (const double phase : {0.001, 0.25, 0.5, 0.83, 0.999}) {
        INFO(name << ", spacing " << d << ", phase " << phase << ", depths " << nearest << " to " << farthest);
        const ProxySlices slices = cutSlices(view, origins, glm::ivec3(8), {}, d, phase);
        REQUIRE(slices.count() > 0);
        CHECK(slices.phase == phase);
        for (std::int64_t i = 0; i < slices.count(); ++i)
          CHECK(slices.depth(i) == Approx((static_cast<double>(slices.first + i) + phase) * d).epsilon(1e-14));
        CHECK(slices.first >= 0);
        // In front of the first slice and behind the last there is no other one in the volume.
        const double rounding = 1e-9;  // of the corners' depths: some 1e-15 of 50
        CHECK(slices.depth(0) > nearest - rounding);
        CHECK((slices.first == 0 || slices.depth(0) - d <= nearest + rounding));
        CHECK(slices.depth(slices.count() - 1) <= farthest + rounding);
        CHECK(slices.depth(slices.count() - 1) + d > farthest - rounding);
      }
  }
}

TEST_CASE("Slices of a phase are those of an eye that stands farther back by as much", "[slice]") {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.eye = {4, -10, 4};
  camera.lookAt = {4, 0, 4};
  camera.up = {0, 0, 1};
  camera.viewHeight = 20;
  const std::vector<glm::ivec3> origins{{0, 0, 0}};
  const ProxySlices slices = cutSlices(indexView(camera, glm::dmat4(1)), origins, glm::ivec3(8), {}, 0.5, 0.25);
  camera.eye.y -= 0.125;
  const ProxySlices moved = cutSlices(indexView(camera, glm::dmat4(1)), origins, glm::ivec3(8), {}, 0.5, 0.5);
  CHECK(moved.first == slices.first);
  CHECK(moved.start == slices.start);
  CHECK(moved.vertices == slices.vertices);
}

TEST_CASE("A phase outside (0, 1) is refused", "[slice]") {
  const IndexView view = indexView(Camera{}, glm::dmat4(1));
  const std::vector origins{glm::ivec3(-4)};
  for (const double phase : {0.0, 1.0, -0.5, 1.5, std::nan("")}) {
    INFO(phase);
    CHECK_THROWS_WITH(cutSlices(view, origins, glm::ivec3(8), {}, 0.5, phase),
                      Catch::Contains("slices: phase is") && Catch::Contains("must be in (0, 1)"));
  }
}

TEST_CASE("A spacing that is not positive or makes too many slices is refused", "[slice]") {
  const Camera camera;
  const IndexView view = indexView(camera, glm::dmat4(1));
  const std::vector origins{glm::ivec3(-4)};
  CHECK_THROWS_AS(cutSlices(view, origins, glm::ivec3(8), {}, 0), InvalidArgument);
  CHECK_THROWS_AS(cutSlices(view, origins, glm::ivec3(8), {}, std::nan("")), InvalidArgument);
  CHECK_THROWS_WITH(cutSlices(view, origins, glm::ivec3(8), {}, 1e-9), Catch::Contains("slices, at most"));
  CHECK_THROWS_AS(cutSlices(view, origins, glm::ivec3(8), {}, 1e-300), InvalidArgument);
  CHECK_THROWS_WITH(indexView(camera, glm::dmat4(0)), Catch::Contains("singular"));
}

TEST_CASE("Slab reach is half the spacing along the ray, per axis", "[slice]") {
  Camera camera;
  camera.eye = {0, -10, 0};
  camera.up = {0, 0, 1};
  camera.projection = Projection::orthographic;
  CHECK(slabReach(indexView(camera, glm::dmat4(2)), 3).y == Approx(0.75));
  CHECK(slabReach(indexView(camera, glm::dmat4(2)), 3).x == Approx(0).margin(1e-12));
  camera.projection = Projection::perspective;
  camera.fov = 1.5707963267948966;
  const glm::dvec3 reach = slabReach(indexView(camera, glm::dmat4(1)), 2);
  CHECK(reach.x == Approx(1));  // 45 degrees at the edge of the image
  CHECK(reach.y == Approx(1));
}
