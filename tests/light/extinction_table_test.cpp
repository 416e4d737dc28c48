// The table from which paths of light take the mean of sigma_t, against the transfer function itself.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/light/extinction_table.h"

#include <catch2/catch.hpp>
#include <vector>

#include "light/sweep_kernels.h"

using namespace umbrick;

namespace {

// Returns the optical depth of a path of length 1 over which the value runs from one number to another.
double depthBetween(const ExtinctionTable& table, float from, float to) {
  const std::vector<float> before(2 + kRowPadding, table.stepsOf(from, 0)), here(before.size(), table.stepsOf(to, 0));
  const PathMedium medium{
      table.integrals(), table.means(), table.below(), table.above(), table.emptyBelow(), table.emptyAbove(), 1};
  std::vector<float> depth(1 + kRowPadding, 0.0f), through(depth);
  carryRow({before.data(), before.data(), 0, 0}, {here.data(), here.data(), 0, 0}, medium, 1, depth.data(),
           through.data(), 1);
  return depth.front();
}

// Returns the mean of sigma_t by the rule of midpoints.
double meanBetween(const TransferFunction& transfer, double from, double to) {
  constexpr int kParts = 200000;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) sum += transfer(from + (to - from) * (i + 0.5) / kParts).sigma_t;
  return sum / kParts;
}

TransferFunction function(std::vector<std::pair<double, double>> points) {
  std::vector<TransferFunction::Point> result;
  for (const auto& [value, sigma_t] : points) result.push_back({value, {glm::dvec3(0.5), sigma_t}});
  return TransferFunction(std::move(result));
}

}  // namespace

TEST_CASE("The mean of sigma_t over values is that of the function", "[light]") {
  // A peak that no voxel may hit, a step, and constant ends of both kinds.
  const std::vector<TransferFunction> functions{function({{0, 0}, {10, 0}, {11, 4}, {12, 0}, {40, 0}}),
                                                function({{3, 0}, {3, 2}}), function({{-5, 1.5}, {20, 0.25}}),
                                                function({{1000, 0}, {1200, 3}, {2000, 3}, {3000, 0.5}})};
  const std::vector<std::pair<float, float>> ranges{{9, 13},  {13, 9},     {0, 40},      {-20, 60},
                                                    {2, 4},   {-9, -7},    {11, 11},     {10.5f, 11.5f},
                                                    {21, 90}, {900, 3500}, {1100, 1100}, {2900, 1000}};
  for (const TransferFunction& transfer : functions) {
    const ExtinctionTable table(transfer);
    // A step of the table smears kinks and steps of the function, and sums of single precision have seven digits.
    const double floor = 5e-3 * transfer.majorant(Range{-1e6f, 1e6f});
    for (const auto& [from, to] : ranges) {
      INFO("from " << from << " to " << to);
      CHECK(depthBetween(table, from, to) == Approx(meanBetween(transfer, from, to)).margin(floor));
    }
  }
}

TEST_CASE("What the function does not show has no optical depth at all", "[light]") {
  const TransferFunction transfer = function({{10, 0}, {11, 4}, {12, 0}, {40, 0}});
  const ExtinctionTable table(transfer);
  for (const auto& [from, to] : std::vector<std::pair<float, float>>{{-1000, 10}, {0, 5}, {12.01f, 40}, {13, 1e6f}}) {
    INFO("from " << from << " to " << to);
    CHECK(depthBetween(table, from, to) == 0);
    CHECK(table.isTransparent(table.stepsOf(from, 0), table.stepsOf(to, 0)) == transfer.isTransparent({from, to}));
  }
  CHECK_FALSE(table.isTransparent(table.stepsOf(9, 0), table.stepsOf(13, 0)));
}

TEST_CASE("Only values that the function shows all the way count as opaque", "[light]") {
  const TransferFunction transfer = function({{10, 0}, {11, 4}, {12, 0}, {20, 0}, {21, 1}, {40, 2}});
  const ExtinctionTable table(transfer);
  const auto isOpaque = [&](float low, float high) {
    return table.isOpaque(table.stepsOf(low, 0), table.stepsOf(high, 0));
  };
  CHECK(isOpaque(10.5f, 11.5f));
  CHECK(isOpaque(21, 39));
  CHECK_FALSE(isOpaque(11.5f, 20.5f));
  CHECK_FALSE(isOpaque(9, 11));
  CHECK_FALSE(isOpaque(30, 41));  // beyond its ends a table does not look
}
