// The loops over rows of voxels: against double precision, and that all sets of instructions agree.
// SPDX-License-Identifier: Apache-2.0
#include "light/sweep_kernels.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/baseline_instructions.h"
#include "umbrick/core/instructions.h"
#include "umbrick/light/extinction_table.h"

using namespace umbrick;

namespace {

// Rows of voxels that go through all of a table and beyond its ends, with paths between them.
struct Rows {
  static constexpr int kCount = 77;  // no whole number of vectors
  std::vector<float> voxels[4];
  std::vector<float> depth;
  explicit Rows(unsigned seed) : depth(kCount + kRowPadding) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-600, 4700), small(0, 3);
    for (auto& row : voxels) {
      row.resize(2 * kCount + 2 + 2 * kRowPadding);
      for (float& voxel : row) voxel = value(random);
    }
    for (float& d : depth) d = small(random);
  }
  PathRow before() const { return {voxels[0].data(), voxels[1].data(), 0.25f, 0.6f}; }
  PathRow here() const { return {voxels[2].data(), voxels[3].data(), 0.7f, 0.1f}; }
  double valueAt(const PathRow& row, int place) const {
    const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
    return mix(mix(row.near[place], row.far[place], row.v), mix(row.near[place + 1], row.far[place + 1], row.v), row.u);
  }
};

// Values are steps of the table of this function.
const TransferFunction kTransfer({{0, {glm::dvec3(1), 0.1}},
                                  {0.3, {glm::dvec3(1), 0}},
                                  {0.5, {glm::dvec3(1), 0}},
                                  {0.7, {glm::dvec3(1), 0.5}},
                                  {1, {glm::dvec3(1), 0.2}}});
const ExtinctionTable kTable(kTransfer);

double sigmaOf(double steps) {
  // What stepsOf() does, the other way round.
  const double first = kTable.stepsOf(0, 0), last = kTable.stepsOf(1, 0);
  return kTransfer((steps - first) / (last - first)).sigma_t;
}

double meanBetween(double from, double to) {
  constexpr int kParts = 20000;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) sum += sigmaOf(from + (to - from) * (i + 0.5) / kParts);
  return sum / kParts;
}

PathMedium medium(float length) {
  return {kTable.integrals(),  kTable.means(),      kTable.below(), kTable.above(),
          kTable.emptyBelow(), kTable.emptyAbove(), length};
}

template <class Work>
void forBothInstructions(const Work& work) {
  for (const bool baseline : {false, true}) {
    useBaselineInstructions(baseline);
    INFO("instructions " << cpuInstructions());
    work();
  }
  useBaselineInstructions(false);
}

}  // namespace

TEST_CASE("Optical depth grows by the mean of sigma_t along each path, for all sets of instructions", "[light]") {
  const int spacing = GENERATE(1, 2);
  INFO("spacing " << spacing);
  forBothInstructions([&] {
    const Rows rows(5);
    std::vector<float> depth = rows.depth, through(depth.size(), -1.0f);
    carryRow(rows.before(), rows.here(), medium(1.5f), spacing, depth.data(), through.data(), Rows::kCount);
    double worst = 0, worstThrough = 0;
    for (int i = 0; i < Rows::kCount; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double mean = meanBetween(rows.valueAt(rows.before(), i * spacing), rows.valueAt(rows.here(), i * spacing));
      worst = std::max(worst, std::abs(depth[at] - rows.depth[at] - 1.5 * mean));
      worstThrough = std::max(worstThrough, std::abs(through[at] - std::exp(-double{depth[at]})));
    }
    // A table has 4088 steps, over which sigma_t changes by 0.0006 at most, and single precision seven digits.
    CHECK(worst < 1e-3);
    CHECK(worstThrough < 1e-6);
    for (std::size_t i = Rows::kCount; i < depth.size(); ++i) CHECK(depth[i] == rows.depth[i]);
  });
}

TEST_CASE("All sets of instructions light voxels alike", "[light]") {
  const int spacing = GENERATE(1, 2);
  std::vector<float> depths[2];
  std::vector<std::int32_t> sums[2];
  for (const bool baseline : {false, true}) {
    useBaselineInstructions(baseline);
    const Rows rows(9);
    std::vector<float> depth = rows.depth, through[2]{std::vector<float>(depth.size()), std::vector<float>(depth)};
    carryRow(rows.before(), rows.here(), medium(2), spacing, depth.data(), through[0].data(), Rows::kCount);
    const RowPlane planes[]{{-3, 0.1f, 0.8f}, {40, -0.6f, -0.3f}};
    carryCutRow(rows.here(), rows.before(), medium(2), planes, 2, spacing, depth.data(), through[1].data(),
                Rows::kCount);
    std::vector<std::int32_t> sum(depth.size(), 0);
    std::int32_t* const light[]{sum.data()};
    addRow(through[0].data() + 1, through[1].data() + 1, {0.3f, 0.8f, {0.2f * kWholeLight}}, 1, light,
           Rows::kCount - 1);
    for (std::size_t i = Rows::kCount - 1; i < sum.size(); ++i) CHECK(sum[i] == 0);
    depths[baseline] = depth;
    sums[baseline] = sum;
  }
  useBaselineInstructions(false);
  double worst = 0, worstSum = 0, most = 0;
  for (std::size_t i = 0; i < sums[0].size(); ++i) {
    // Products are not rounded before they are added where the machine can do so. That may also decide to which of two
    // steps of the table a value half-way between them belongs.
    worst = std::max(worst, std::abs(double{depths[0][i]} - depths[1][i]));
    worstSum = std::max(worstSum, std::abs(double(sums[0][i]) - sums[1][i]) / double{kWholeLight});
    most = std::max(most, double(sums[0][i]) / double{kWholeLight});
  }
  CHECK(most > 0.05);
  CHECK(worst < 1e-3);
  CHECK(worstSum < 2e-4);
}

TEST_CASE("Light that is taken away leaves nothing behind", "[light]") {
  const Rows rows(3);
  std::vector<float> depth = rows.depth, through(depth);
  carryRow(rows.before(), rows.here(), medium(1), 1, depth.data(), through.data(), Rows::kCount);
  std::vector<std::int32_t> sum(depth.size(), 7);
  std::int32_t* const light[]{sum.data()};
  for (const float factor : {1.0f, -1.0f})
    addRow(through.data() + 1, through.data() + 1, {0.3f, 0.8f, {factor * 0.037f * kWholeLight}}, 1, light,
           Rows::kCount - 1);
  CHECK(sum == std::vector<std::int32_t>(depth.size(), 7));
}

TEST_CASE("Dark paths are not followed", "[light]") {
  const Rows rows(4);
  std::vector<float> depth(rows.depth.size(), kDarkDepth), through(depth);
  carryRow(rows.before(), rows.here(), medium(1), 1, depth.data(), through.data(), Rows::kCount);
  for (int i = 0; i < Rows::kCount; ++i) {
    CHECK(through[static_cast<std::size_t>(i)] == 0);
    CHECK(depth[static_cast<std::size_t>(i)] == kDarkDepth);
  }
}
