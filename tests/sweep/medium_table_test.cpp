// The table of the medium: its integrals, and what it says is transparent.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/medium_table.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random_transfer.h"

using namespace umbrick;

namespace {

// Returns the mean of channel c between two steps as the table has it.
double tableMean(const MediumTable& table, int from, int to, int c) {
  const auto at = [&](int step) { return static_cast<double>(table.sums()[4 * step + c]) * table.sumUnit(); };
  return (at(to) - at(from)) / (to - from);
}

double channel(const Medium& medium, int c) { return c == 0 ? medium.sigma_t : medium.sigma_s()[c - 1]; }

// The mean of a function over values, by the midpoint rule with so many parts.
double mean(const TransferFunction& transfer, double low, double high, int c) {
  constexpr int kParts = 200000;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) sum += channel(transfer(low + (i + 0.5) / kParts * (high - low)), c);
  return sum / kParts;
}

}  // namespace

TEST_CASE("Sums of a medium table are the integrals of the function", "[sweep]") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 8; ++trial) {
    const TransferFunction transfer = randomTransferFunction(random, 3 + trial);
    const MediumTable table(transfer, 41.5, 1e9);
    const auto valueOf = [&](int step) { return table.origin() + (step - table.first()) / table.perUnit(); };
    for (const auto& [from, to] : {std::pair{0, table.steps()}, {100, 900}, {1000, 1001}, {2500, 2900}})
      for (int c = 0; c < 4; ++c) {
        INFO("trial " << trial << ", steps " << from << " to " << to << ", channel " << c);
        // The midpoint rule is off by a part of a step at each jump, of up to 5 units.
        const double margin = 1e-6 + 5.0 * transfer.values().size() * 1e-5;
        CHECK(tableMean(table, from, to, c) == Approx(mean(transfer, valueOf(from), valueOf(to), c)).margin(margin));
      }
  }
}

TEST_CASE("The value of empty space is met by a step to the last bit", "[sweep]") {
  // The only transparent value of a solid medium.
  const TransferFunction transfer({{-3.7, {glm::dvec3(1), 2}}, {0.125, {glm::dvec3(1), 0}}, {7.3, {glm::dvec3(1), 2}}});
  const MediumTable table(transfer, 0.125, 1e9);
  const double step = table.stepsOf(0.125);
  CHECK(step == std::round(step));
  CHECK(table.points()[4 * static_cast<int>(step)] == 0);
  CHECK(table.isTransparent({0.125f, 0.125f}, {0, 0}));
  CHECK_FALSE(table.isTransparent({0.12f, 0.13f}, {0, 0}));
}

TEST_CASE("What a medium table calls transparent is so", "[sweep]") {
  std::mt19937 random(5);
  int transparent = 0, visible = 0;
  for (int trial = 0; trial < 20; ++trial)
    for (const bool is2d : {false, true}) {
      const TransferFunction transfer = is2d ? randomTransferFunction2d(random, 4) : randomTransferFunction(random, 6);
      const MediumTable table(transfer, 0, 1e9);
      for (int i = 0; i < 200; ++i) {
        const float low = uniform(random, -10, 110), high = low + uniform(random, 0, 1) * uniform(random, 0, 20);
        const float soft = uniform(random, 0, 100), steep = soft + uniform(random, 0, 5);
        const Range gradient = is2d ? Range{soft, steep} : Range{0, 0};
        const bool isTransparent = transfer.isTransparent({low, high}, gradient);
        const bool found = table.isTransparent({low, high}, gradient);
        // What a 2D function shows between two steps of the gradient alone is none of it.
        if (!isTransparent && !is2d) CHECK_FALSE(found);
        if (isTransparent && found) ++transparent;
        if (!isTransparent && !found) ++visible;
      }
    }
  // Both are found mostly.
  CHECK(transparent > 100);
  CHECK(visible > 1000);
}

TEST_CASE("Extinction that is opaque over any segment leaves the rest of a table exact", "[sweep]") {
  const TransferFunction transfer(
      {{0, {glm::dvec3(1), 0.01}}, {1, {glm::dvec3(1), 0.01}}, {1, {glm::dvec3(1), 1e30}}, {2, {glm::dvec3(1), 1e30}}});
  const MediumTable table(transfer, 0, 1e5);
  const int middle = static_cast<int>(table.stepsOf(0.5));
  // One unit of the sums over eight steps.
  CHECK(tableMean(table, middle, middle + 8, 0) == Approx(0.01).margin(table.sumUnit() / 8));
  CHECK(table.sumUnit() < 0.4);  // half of 16384 steps of 1e5, in 31 bits
  CHECK(table.points()[4 * middle] == Approx(0.01));
}
