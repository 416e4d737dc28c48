// Where rays meet meshes.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/mesh/mesh.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "support/test_meshes.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("A plane is met where it is, also from far away", "[mesh]") {
  const Mesh mesh(squareMesh({-3, -2}, {5, 4}, 7));
  for (const double far : {1.0, 1e3, 1e7}) {
    const auto hit = mesh.first({1.1, 0.7, 7 + far}, {0, 0, -0.5}, 0);
    REQUIRE(hit);
    CHECK(hit->t == Approx(2 * far).epsilon(1e-12));
    CHECK(std::abs(hit->normal.z) == 1);
  }
  CHECK_FALSE(mesh.first({1, 1, 8}, {0, 0, 1}, 0));     // it lies behind
  CHECK_FALSE(mesh.first({1, 1, 8}, {0, 0, -1}, 1.5));  // or before what counts
  CHECK_FALSE(mesh.first({6, 1, 8}, {0, 0, -1}, 0));    // or aside
  CHECK_FALSE(mesh.first({1, 1, 7.5}, {1, 0, 0}, 0));   // or the ray runs along it
  CHECK(mesh.first({1, 1, 6}, {0, 0, 1}, 0)->t == 1);   // from the other side, too
  CHECK(mesh.triangles() == 2);
  CHECK(mesh.corners() == std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
  CHECK(mesh.vertices()[2] == glm::dvec3(5, 4, 7));
  CHECK(mesh.bounds().max == glm::dvec3(5, 4, 7));
}

// Triangles share edges, between which no ray slips through: all rays from within a closed mesh end.
TEST_CASE("A sphere is met from all sides, near to where it is", "[mesh]") {
  const glm::dvec3 centre(200, -300, 100);
  const double radius = 12;
  constexpr unsigned kRings = 40;
  const Mesh mesh(sphereMesh(centre, radius, kRings));
  Random random(3, 0);
  const auto number = [&] { return 2 * random.uniform() - 1; };
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 direction(number(), number(), number());
    if (glm::length(direction) < 0.1) continue;
    const glm::dvec3 along = glm::normalize(direction);
    const auto out = mesh.first(centre, along, 0), in = mesh.first(centre - 40.0 * along, along, 0);
    REQUIRE(out);
    REQUIRE(in);
    // Chords of circles: 1 - cos of half the angle between two corners, in two directions.
    const double within = 2 * radius * (1 - std::cos(std::numbers::pi / kRings / 2)) + 1e-4;
    CHECK(out->t <= radius + 1e-4);
    CHECK(out->t >= radius - within);
    CHECK(std::abs(40 - in->t - radius) <= within);
    CHECK(glm::dot(out->normal, along) > 0.999);
  }
}

TEST_CASE("A mesh without normals has those of its triangles", "[mesh]") {
  TriangleMesh triangles = sphereMesh({0, 0, 0}, 1, 8);
  triangles.normals.clear();
  const Mesh mesh(triangles);
  const auto hit = mesh.first({0.3, 0.2, 5}, {0, 0, -1}, 0);
  REQUIRE(hit);
  // The normal of the triangle is across to its plane: a step along the plane stays on it.
  const auto near = mesh.first({0.301, 0.2, 5}, {0, 0, -1}, 0);
  const glm::dvec3 step(0.001, 0, hit->t - near->t);
  CHECK(std::abs(glm::dot(hit->normal, step)) < 1e-9);
}

TEST_CASE("Meshes that are none are refused in one line", "[mesh]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(Mesh(TriangleMesh{{{0, 0, 0}}, {}, {}}, "m.ply"), "m.ply: expected triangles, found none");
  CHECK_THROWS_WITH(Mesh(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, {}, {{0, 1, 2}}}, "m.ply"),
                    "m.ply: vertex 2 of 3 is not finite");
  CHECK_THROWS_WITH(Mesh(TriangleMesh{{{0, 0, 0}, {1, 0, 0}}, {}, {{0, 1, 2}}}, "m.ply"),
                    "m.ply: a triangle has the vertex 2, there are 2");
  CHECK_THROWS_WITH(Mesh(TriangleMesh{{{0, 0, 0}, {1e19, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}}, "m.ply"),
                    Contains("smaller than 1e18 world units"));
}
