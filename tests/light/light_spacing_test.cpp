// Light at every second voxel: how near it comes to light at each, what it says of that, and when it is chosen.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "light/lit_medium.h"
#include "support/field_bricks.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/optics/directions.h"

using namespace umbrick;

namespace {

// A smooth cloud in a box of `size` voxels.
auto cloud(int size) {
  return [size](const glm::ivec3& i) {
    const glm::dvec3 p = (glm::dvec3(i) + 0.5) / static_cast<double>(size) - 0.5;
    const double r2 = 5 * glm::dot(p, p) + 0.1 * std::sin(17 * p.x) * std::sin(13 * p.y);
    return r2 < 1 ? (1 - r2) * (1 - r2) : 0.0;
  };
}

LightMedium mediumOf(const Bricks& volume, const TransferFunction& transfer, int spacing) {
  LightMedium medium{transfer, {}, {}, {}};
  medium.spacing = spacing;
  for (const WeightedDirection& one : spiralDirections(glm::normalize(glm::dvec3(0.3, -0.2, 1)), 60 * kDegree, 16))
    medium.directions.push_back({one.direction, glm::dvec3(one.weight)});
  for (const Brick& brick : volume.bricks)
    if (!transfer.isTransparent(brick.value)) medium.cells.push_back(brick.origin);
  return medium;
}

// Calls visit(value, light, other) at each owned voxel that has medium.
template <class Visit>
void forEachLit(const FieldBricks& volume, const LightMedium& medium, const LightVolume& light,
                const LightVolume& other, const Visit& visit) {
  const glm::ivec3 edge = volume.layout.edge();
  std::vector<float> a(volume.layout.voxels()), b(a), values(a);
  for (const glm::ivec3& cell : medium.cells) {
    light.read(cell, a);
    other.read(cell, b);
    volume.read(cell, values);
    for (int z = 1; z + 1 < edge.z; ++z)
      for (int y = 1; y + 1 < edge.y; ++y)
        for (int x = 1; x + 1 < edge.x; ++x) {
          const auto i = static_cast<std::size_t>((z * edge.y + y) * edge.x + x);
          if (values[i] > 0) visit(cell + glm::ivec3(x, y, z) - 1, a[i], b[i]);
        }
  }
}

}  // namespace

TEST_CASE("Light at every second voxel is that of each voxel but for the way between", "[light]") {
  std::vector<double> errors;
  for (const int size : {32, 64}) {
    // The same cloud, as dark at twice the resolution.
    const FieldBricks volume(cloud(size), {glm::ivec3(0), glm::ivec3(size - 1)});
    const LightMedium fine = mediumOf(volume, proportional(0.15 * 64 / size), 1);
    const LightMedium coarse = mediumOf(volume, proportional(0.15 * 64 / size), 2);
    LightVolume each(volume), second(volume);
    each.update(fine, kPlenty);
    second.update(coarse, kPlenty);
    CHECK(second.stats().spacing == 2);
    CHECK(second.stats().updates < 0.4 * static_cast<double>(each.stats().updates));
    CHECK(second.stats().heldBytes < 0.3 * static_cast<double>(each.stats().heldBytes));  // aprons count in bricks of 8
    double sum = 0, count = 0, atPlaces = 0, least = 1;
    forEachLit(volume, fine, each, second, [&](const glm::ivec3& p, float a, float b) {
      const double difference = std::abs(double{a} - double{b});
      sum += difference * difference;
      ++count;
      if (p.x % 2 == 0 && p.y % 2 == 0 && p.z % 2 == 0) atPlaces = std::max(atPlaces, difference);
      least = std::min(least, double{a});
    });
    const double error = std::sqrt(sum / count), stated = second.stats().spacingError;
    INFO("size " << size << ": error " << error << ", stated " << stated << ", at places " << atPlaces);
    CHECK(least < 0.6);
    CHECK(each.stats().spacingError == 0);
    // An estimate, from places that are farther apart.
    CHECK(stated > 0.7 * error);
    CHECK(stated < 1.5 * error);
    errors.push_back(error);
  }
  CHECK(errors[0] > 3 * errors[1]);  // 4 for the second order
}

TEST_CASE("Light at every second voxel is the same however the volume is cut into bricks", "[light]") {
  FieldOptions small, large;
  small.interior = 8;
  large.interior = 40;
  const FieldBricks a(cloud(40), {glm::ivec3(0), glm::ivec3(39)}, small);
  const FieldBricks b(cloud(40), {glm::ivec3(0), glm::ivec3(39)}, large);
  const LightMedium medium = mediumOf(a, proportional(0.3), 2);
  LightVolume bricked(a), whole(b);
  bricked.update(medium, kPlenty);
  whole.update(mediumOf(b, proportional(0.3), 2), kPlenty);
  std::vector<float> all(b.layout.voxels()), block(a.layout.voxels()), values(block);
  whole.read({0, 0, 0}, all);
  double worst = 0;
  for (const glm::ivec3& cell : medium.cells) {
    bricked.read(cell, block);
    a.read(cell, values);
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          const glm::ivec3 p = cell + glm::ivec3(x, y, z);
          if (p.x < 0 || p.y < 0 || p.z < 0 || p.x > 39 || p.y > 39 || p.z > 39) continue;
          const auto i = static_cast<std::size_t>(((z + 1) * 10 + y + 1) * 10 + x + 1);
          if (values[i] == 0) continue;
          const auto j = static_cast<std::size_t>(((p.z + 1) * 42 + p.y + 1) * 42 + p.x + 1);
          worst = std::max(worst, std::abs(double{block[i]} - double{all[j]}));
        }
  }
  CHECK(worst < 1.01 / 65535);  // a step
}

TEST_CASE("Light is held at every second voxel where there is no memory for each", "[light]") {
  const FieldBricks volume(cloud(40), {glm::ivec3(0), glm::ivec3(39)});
  LightVolume light(volume);
  LightMedium medium = mediumOf(volume, proportional(0.3), 0);
  light.update(medium, kPlenty);
  CHECK(light.stats().spacing == 1);
  const std::uint64_t each = light.stats().bytes;
  medium.spacing = 2;
  light.update(medium, kPlenty);
  const std::uint64_t second = light.stats().bytes;
  REQUIRE(second < each);
  medium.spacing = 0;
  light.update(medium, each - 1);
  CHECK(light.stats().spacing == 2);
  CHECK(light.stats().spacingError > 0);
  CHECK_THROWS_WITH(light.update(mediumOf(volume, proportional(0.2), 0), second - 1),
                    Catch::Contains("even at every second voxel"));
  // What was asked for is not changed in silence.
  CHECK_THROWS_AS(light.update(mediumOf(volume, proportional(0.3), 1), each - 1), InvalidArgument);
}
