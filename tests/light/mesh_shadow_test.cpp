// What a mesh keeps from a medium: light that its rays say, from wherever it is.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "light/lit_medium.h"
#include "support/field_bricks.h"
#include "support/test_meshes.h"
#include "support/test_scenes.h"
#include "umbrick/optics/directions.h"

using namespace umbrick;

namespace {

constexpr double kCode = 1.01 / 65535;  // light is rounded to these

// A block of medium that is thin enough for light to get everywhere, in bricks of 8 voxels.
constexpr int kSide = 24;
const FieldBricks& thinBlock() {
  static const FieldBricks bricks([](const glm::ivec3&) { return 1.0; }, {glm::ivec3(0), glm::ivec3(kSide - 1)});
  return bricks;
}

std::shared_ptr<const Mesh> shared(const TriangleMesh& mesh) { return std::make_shared<Mesh>(mesh); }

// A square around a centre, across a normal.
TriangleMesh squareAcross(const glm::dvec3& centre, const glm::dvec3& normal, double half) {
  const glm::dvec3 n = glm::normalize(normal);
  const glm::dvec3 a =
      half * glm::normalize(glm::cross(n, std::abs(n.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 b = glm::cross(n, a);
  return {{centre - a - b, centre + a - b, centre + a + b, centre - a + b}, {}, {{0, 1, 2}, {0, 2, 3}}};
}

std::vector<LightDirection> coneOf(const glm::dvec3& axis, double aperture, int count) {
  std::vector<LightDirection> result;
  for (const WeightedDirection& one : spiralDirections(glm::normalize(axis), aperture, count))
    result.push_back({one.direction, glm::dvec3(one.weight)});
  return result;
}

template <class Visit>
void forEachInBlock(int step, const Visit& visit) {
  for (int z = 0; z < kSide; z += step)
    for (int y = 0; y < kSide; y += step)
      for (int x = 0; x < kSide; x += step) visit(glm::ivec3(x, y, z));
}

}  // namespace

TEST_CASE("A mesh keeps light from what its rays meet and from nothing else", "[light][mesh]") {
  const glm::dvec3 middle(11.3, 12.1, 11.7);
  const int spacing = GENERATE(1, 2);
  const glm::dvec3 towards =
      GENERATE(glm::dvec3(0, 0, 1), glm::dvec3(0.4, -0.3, 0.9), glm::dvec3(-0.8, 0.1, 0.6), glm::dvec3(0.2, 1, -0.7),
               glm::dvec3(0.1, -0.5, 0.2), glm::dvec3(0.6, 0.7, -0.9), glm::dvec3(-1, 1, -1));
  const glm::dvec3 direction = glm::normalize(towards);
  LightMedium medium = mediumOf(thinBlock(), proportional(0.02), {{direction, glm::dvec3(1)}});
  medium.spacing = spacing;
  const LitVoxels bare(thinBlock(), medium);
  // Within the block and outside of all bricks, across the light and aslant, flat and closed.
  const glm::dvec3 aslant = direction + 0.7 * glm::normalize(glm::cross(direction, {0.3, 0.5, 0.8}));
  const TriangleMesh meshes[]{squareAcross(middle, direction, 8), squareAcross(middle, aslant, 11),
                              squareAcross(middle + 60.0 * direction, aslant, 9), sphereMesh(middle, 8, 16),
                              sphereMesh(middle + 200.0 * direction, 8, 16)};
  for (std::size_t which = 0; which < std::size(meshes); ++which) {
    medium.mesh = shared(meshes[which]);
    const LitVoxels lit(thinBlock(), medium);
    INFO("mesh " << which << ", spacing " << spacing << ", light from " << towards.x << ", " << towards.y << ", "
                 << towards.z);
    int dark = 0, bright = 0;
    double darkest = 0;
    bool same = true, between = true;
    forEachInBlock(2, [&](const glm::ivec3& p) {
      // Light at a voxel is that of the paths around it, and of the places of light around it.
      int met = 0;
      for (int i = 0; i < 125; ++i) {
        const glm::dvec3 around(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2);
        met += medium.mesh->first(glm::dvec3(p) + double(spacing) * around, direction, 0).has_value();
      }
      if (met == 125) {
        ++dark;
        darkest = std::max(darkest, lit.at(p));
      } else if (met == 0) {
        ++bright;
        same = same && lit.at(p) == bare.at(p);
      } else {
        between = between && lit.at(p) <= bare.at(p) + kCode;
      }
    });
    CHECK(dark > 2);
    CHECK(bright > 20);
    CHECK(darkest < kCode);
    CHECK(same);
    CHECK(between);
  }
}

TEST_CASE("A wall leaves a column as much light as there is space before it", "[light][mesh]") {
  const int spacing = GENERATE(1, 2);
  LightMedium medium = mediumOf(thinBlock(), proportional(1e-7), {{glm::dvec3(0, 0, 1), glm::dvec3(1)}});
  medium.spacing = spacing;
  for (const double height : {12.0, 12.25, 12.5, 13.1, 13.9}) {
    medium.mesh = shared(squareMesh({-50, -50}, {50, 50}, height));
    const LitVoxels lit(thinBlock(), medium);
    double sum = 0;
    for (int z = 4; z < 20; ++z) sum += lit.at({9, 14, z});
    CHECK(sum == Approx(19.5 - height).margin(1e-3));
  }
  // One that is aslant: the place of its shadow's border runs on evenly.
  medium.mesh = shared(squareAcross({12, 12, 12}, {0.3, 0, 1}, 60));
  const LitVoxels lit(thinBlock(), medium);
  for (int x = 4; x < 20; x += 2) {
    double sum = 0;
    for (int z = 2; z < 22; ++z) sum += lit.at({x, 14, z});
    CHECK(sum == Approx(21.5 - (12 - 0.3 * (x - 12))).margin(1e-3));
  }
}

TEST_CASE("The edge of a shadow lies within a voxel of where it is", "[light][mesh]") {
  // Straight down, paths are the voxels.
  LightMedium medium = mediumOf(thinBlock(), proportional(0.02), {{glm::dvec3(0, 0, 1), glm::dvec3(1)}});
  const LitVoxels bare(thinBlock(), medium);
  medium.mesh = shared(squareMesh({5.5, 7.5}, {14.5, 17.5}, 30));
  const LitVoxels lit(thinBlock(), medium);
  forEachInBlock(1, [&](const glm::ivec3& p) {
    const bool below = p.x > 5 && p.x < 15 && p.y > 7 && p.y < 18;
    if (below ? lit.at(p) >= kCode : lit.at(p) != bare.at(p))
      FAIL(p.x << " " << p.y << " " << p.z << ": " << lit.at(p));
  });
}

TEST_CASE("The shadow of a mesh is the same however the volume is cut into bricks", "[light][mesh]") {
  const auto field = [](const glm::ivec3& i) {
    return std::max(0.0, 1 - glm::length(glm::dvec3(i) - glm::dvec3(20, 18, 22)) / 16);
  };
  const IndexBox box{glm::ivec3(0), glm::ivec3(39)};
  FieldOptions large;
  large.interior = 40;
  const FieldBricks bricked(field, box), whole(field, box, large);
  const auto mesh = shared(sphereMesh({24, 15, 30}, 8, 20));
  for (const int spacing : {1, 2})
    for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(-0.5, 0.8, 0.3), glm::dvec3(0.9, -0.2, -0.4)}) {
      LightMedium a = mediumOf(bricked, proportional(0.2), coneOf(axis, 60 * kDegree, 20));
      LightMedium b = mediumOf(whole, proportional(0.2), coneOf(axis, 60 * kDegree, 20));
      a.mesh = b.mesh = mesh;
      a.spacing = b.spacing = spacing;
      const LitVoxels litA(bricked, a), litB(whole, b);
      double worst = 0;
      for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 40; ++y)
          for (int x = 0; x < 40; ++x)
            if (field({x, y, z}) > 0) worst = std::max(worst, std::abs(litA.at({x, y, z}) - litB.at({x, y, z})));
      CHECK(worst < kCode);
    }
}

TEST_CASE("A mesh that comes, moves and goes leaves the light of a fresh sweep", "[light][mesh]") {
  const FieldBricks volume([](const glm::ivec3& i) { return 0.5 + 0.5 * std::sin(0.4 * i.x) * std::cos(0.3 * i.y); },
                           {glm::ivec3(0), glm::ivec3(63, 63, 23)});
  LightMedium medium = mediumOf(volume, proportional(0.1), coneOf({0.3, 0.2, 1}, 20 * kDegree, 12));
  LightVolume light(volume);
  std::vector<float> ours(volume.layout.voxels()), theirs(ours);
  const auto isFresh = [&](int roundings) {
    LightVolume fresh(volume);
    fresh.update(medium, kPlenty);
    double worst = 0, most = 1;
    for (const glm::ivec3& cell : medium.cells) {
      light.read(cell, ours);
      fresh.read(cell, theirs);
      for (std::size_t i = 0; i < ours.size(); ++i) {
        most = std::max(most, double{theirs[i]});  // more than 1 beyond a cut
        worst = std::max(worst, std::abs(double{ours[i]} - double{theirs[i]}));
      }
    }
    return worst < roundings * kCode * most;
  };
  light.update(medium, kPlenty);
  for (const double height : {30.0, 12.0}) {
    medium.mesh = shared(sphereMesh({20, 30, height}, 9, 12));
    CHECK(light.update(medium, kPlenty));
    CHECK_FALSE(light.stats().edited);
    CHECK(isFresh(1));
    CHECK_FALSE(light.update(medium, kPlenty));
  }
  // Edits of the medium and of the light beside a mesh that stays, each of which rounds light once more.
  medium.planes.emplace_back(-1, -1, 0, 116.3);
  CHECK(light.update(medium, kPlenty));
  CHECK(light.stats().edited);
  CHECK(isFresh(2));
  medium.directions.pop_back();
  CHECK(light.update(medium, kPlenty));
  CHECK(light.stats().edited);
  CHECK(isFresh(3));
  medium.mesh.reset();
  CHECK(light.update(medium, kPlenty));
  CHECK(isFresh(1));
}
