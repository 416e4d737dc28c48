// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "grid/sparse_rule.h"

namespace umbrick {
namespace {

// The facts that decide whether half floats will do.
struct HalfSurvey {
  float largest = 0;     // largest magnitude, grid units
  double halfError = 0;  // grid units; infinite where a value is out of range
  void include(float value) {
    if (!std::isfinite(value)) return;
    largest = std::max(largest, std::abs(value));
    const auto half = static_cast<float>(openvdb::math::half(value));
    halfError = std::max(halfError, std::abs(static_cast<double>(value) - static_cast<double>(half)));
  }
  void include(const HalfSurvey& other) {
    largest = std::max(largest, other.largest);
    halfError = std::max(halfError, other.halfError);
  }
};

HalfSurvey survey(const openvdb::FloatTree& tree) {
  openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(tree);
  HalfSurvey all = tbb::parallel_reduce(
      leaves.leafRange(64), HalfSurvey{},
      [](const auto& range, HalfSurvey part) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) part.include(leaf->getValue(i));
        return part;
      },
      [](HalfSurvey a, const HalfSurvey& b) {
        a.include(b);
        return a;
      });
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) all.include(*tile);
  all.include(tree.background());
  return all;
}

}  // namespace

BuildOptions storageWithin(const openvdb::FloatTree& tree, const BuildOptions& options) {
  const float maxError = *options.maxError;
  const HalfSurvey values = survey(tree);
  BuildOptions chosen = options;
  chosen.tolerance = maxError;
  chosen.maxError.reset();
  chosen.half = false;
  // The step is the largest power of two whose rounding error is within the limit. Floats hold its multiples exactly up
  // to 2^24 of them, half floats up to 2^11. Where values are too large for that, they are stored without steps.
  constexpr int kFloatBits = 24, kHalfBits = 11;
  constexpr float kSmallestHalf = 0x1p-24f, kLargestHalf = 65504;
  const float step = maxError > 0x1p-100f ? std::ldexp(1.0f, std::ilogb(2 * std::min(maxError, 1e37f))) : 0.0f;
  const bool steps = step > std::ldexp(values.largest, -kFloatBits);
  const bool backgroundFits = static_cast<float>(openvdb::math::half(tree.background())) == tree.background();
  const bool halfSteps = step >= kSmallestHalf && values.largest + step <= kLargestHalf &&
                         values.largest + step <= std::ldexp(step, kHalfBits);
  chosen.step = 0;
  if (backgroundFits && values.halfError == 0) {
    chosen.half = true;
  } else if (backgroundFits && halfSteps) {
    chosen.half = true;
    chosen.step = step;
  } else if (backgroundFits && values.halfError <= static_cast<double>(maxError)) {
    chosen.half = true;
  } else if (steps) {
    chosen.step = step;
  }
  return chosen;
}

}  // namespace umbrick
