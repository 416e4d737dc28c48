// SPDX-License-Identifier: Apache-2.0
#include "shade/screen_region.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "shade/footprint.h"
#include "shade/occlusion_sweep.h"

using namespace umbrick;

namespace {

// Makes a sweep of opaque and translucent rectangles as the renderer's occlusion pass does: with two buffers in turn,
// and pixels carried only inside `regions`. Collects what covered pixels read.
std::vector<double> sweep(const std::vector<ScreenRegion>& covered, const std::vector<SliceStep>& steps,
                          const std::vector<double>& through, const std::vector<glm::dvec2>& disk, int width,
                          int height, const glm::dvec2& axis, const std::vector<ScreenRegion>& regions) {
  Plane buffers[2] = {Plane(width, height, 1), Plane(width, height, 1)};
  int previous = 0;
  std::vector<double> read;
  const auto inside = [](const ScreenRegion& region, int x, int y) {
    return x >= region.min.x && x < region.max.x && y >= region.min.y && y < region.max.y;
  };
  for (std::size_t slice = 0; slice < covered.size(); ++slice) {
    const Plane& before = buffers[previous];
    Plane& after = buffers[1 - previous];
    const SliceStep& step = steps[slice];
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool isCovered = inside(covered[slice], x, y);
        if (!isCovered && !inside(regions[slice], x, y)) continue;
        const double px = axis.x + (x + 0.5 - axis.x) * step.scale;
        const double py = axis.y + (y + 0.5 - axis.y) * step.scale;
        if (isCovered) read.push_back(before.bilinear(px, py));
        double sum = 0;
        for (const glm::dvec2& point : disk)
          sum += before.bilinear(px + step.radius * point.x, py + step.radius * point.y);
        after.at(x, y) = sum / static_cast<double>(disk.size()) * (isCovered ? through[slice] : 1);
      }
    previous = 1 - previous;
  }
  return read;
}

}  // namespace

// All that bricks read must be what a sweep of whole images gives, except for what a random walk carries farther than
// kWalkReach deviations: 3e-5.
TEST_CASE("Outside of its region occlusion is 1 or is read no more", "[shade][slow]") {
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  double worst = 0, smallest = 1;
  for (int round = 0; round < 120; ++round) {
    const int width = 20 + static_cast<int>(uniform(0, 60)), height = 20 + static_cast<int>(uniform(0, 20));
    const int count = 10 + static_cast<int>(uniform(0, 40));
    const bool perspective = round % 2;
    // Half of the image planes are shifted, by half a pixel at most.
    const glm::dvec2 shift =
        round % 4 < 2 ? glm::dvec2(0) : glm::dvec2(round % 3 - 1, round % 5 - 2) * glm::dvec2(0.5, 0.25);
    const glm::dvec2 axis = 0.5 * glm::dvec2(width, height) + shift;
    const double tangent = uniform(0.1, 3), pixelsPerSlice = uniform(0.2, 1), nearest = uniform(0.5, 20);
    const std::vector<glm::dvec2> disk = diskGrid(1 + round % 4);
    double diskVariance = 0;
    for (const glm::dvec2& p : disk) diskVariance += 0.5 * glm::dot(p, p) / static_cast<double>(disk.size());
    std::vector<ScreenRegion> covered;
    std::vector<SliceStep> steps;
    std::vector<double> through;
    for (int i = 0; i < count; ++i) {
      // Depths are in slices: nearest + i; lengths shrink with the depth of the slice before.
      const double before = nearest + i - 1;
      SliceStep step{1, tangent * pixelsPerSlice, 0};
      if (perspective)
        step = before <= 0 ? SliceStep{1, 0, 0}
                           : SliceStep{(before + 1) / before, tangent * pixelsPerSlice * 10 / before, 0};
      step.deviation = std::sqrt(diskVariance * step.radius * step.radius + 1.0 / 6);
      steps.push_back(step);
      ScreenRegion region;
      if (uniform(0, 1) < 0.3) {
        region.min = {static_cast<int>(uniform(-10, width)), static_cast<int>(uniform(-10, height))};
        region.max = region.min + glm::ivec2(static_cast<int>(uniform(1, 20)), static_cast<int>(uniform(1, 15)));
        region.min = glm::max(region.min, glm::ivec2(0));
        region.max = glm::min(region.max, glm::ivec2(width, height));
      }
      covered.push_back(region.empty() ? ScreenRegion{} : region);
      through.push_back(uniform(0, 1) < 0.5 ? 0.0 : uniform(0, 1));
    }
    const std::vector<ScreenRegion> whole(covered.size(), ScreenRegion{{0, 0}, {width, height}});
    const std::vector<ScreenRegion> regions = occlusionRegions(covered, steps, {width, height}, axis);
    const auto exact = sweep(covered, steps, through, disk, width, height, axis, whole);
    const auto limited = sweep(covered, steps, through, disk, width, height, axis, regions);
    REQUIRE(exact.size() == limited.size());
    for (std::size_t i = 0; i < exact.size(); ++i) {
      INFO("round " << round << " exact " << exact[i] << " limited " << limited[i]);
      if (std::abs(exact[i] - limited[i]) > 3e-5) CHECK(std::abs(exact[i] - limited[i]) <= 3e-5);
      worst = std::max(worst, std::abs(exact[i] - limited[i]));
      smallest = std::min(smallest, exact[i]);
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
      CHECK(regions[i].min.x >= 0);
      CHECK(regions[i].max.x <= width);
      CHECK(regions[i].min.y >= 0);
      CHECK(regions[i].max.y <= height);
    }
  }
  INFO("largest difference " << worst);
  CHECK(worst <= 3e-5);
  CHECK(smallest < 0.1);  // some pixels were in deep shadow
}

TEST_CASE("Regions are no larger than light can spread and is wanted", "[shade]") {
  const glm::ivec2 size(400, 300);
  const ScreenRegion spot{{200, 150}, {202, 152}}, none;
  const std::vector<SliceStep> steps(5, SliceStep{1, 2, 1});
  // In front of the first and behind the last brick there is nothing to carry.
  const auto single =
      occlusionRegions(std::vector<ScreenRegion>{none, none, spot, none, none}, steps, size, 0.5 * glm::dvec2(size));
  CHECK(single[0].empty());
  CHECK(single[1].empty());
  CHECK(single[3].empty());
  CHECK(single[4].empty());
  const auto pair =
      occlusionRegions(std::vector<ScreenRegion>{spot, none, none, none, spot}, steps, size, 0.5 * glm::dvec2(size));
  for (int i = 0; i < 4; ++i) {
    INFO("slice " << i);
    CHECK_FALSE(pair[static_cast<std::size_t>(i)].empty());
    CHECK(pair[static_cast<std::size_t>(i)].extent().x < 2 + 2 * (kWalkReach * 2 + 2 * 3 + 2));
  }
}

TEST_CASE("Regions unite and intersect as sets of pixels", "[shade]") {
  ScreenRegion a{{2, 3}, {6, 8}};
  const ScreenRegion b{{4, 1}, {9, 5}};
  ScreenRegion joined = a, common = a, apart = a;
  joined.include(b);
  CHECK(joined == ScreenRegion{{2, 1}, {9, 8}});
  joined.include({});
  CHECK(joined == ScreenRegion{{2, 1}, {9, 8}});
  common.intersect(b);
  CHECK(common == ScreenRegion{{4, 3}, {6, 5}});
  apart.intersect({{6, 3}, {9, 8}});
  CHECK(apart.empty());
  ScreenRegion empty;
  empty.include(b);
  CHECK(empty == b);
  CHECK(ScreenRegion{{5, 5}, {4, 9}}.extent() == glm::ivec2(0));
}
