// SPDX-License-Identifier: Apache-2.0
#include "light/sweep_kernels.h"

#include <bit>
#include <cstdint>

#include "light/extinction_table.h"

// The loops are compiled for several sets of instructions, and the machine picks one when the program starts. Results
// are the same to the bit, since products and sums are not contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define UMBRICK_WIDE __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define UMBRICK_WIDE
#endif
#define UMBRICK_INLINE inline __attribute__((always_inline))

namespace umbrick {
namespace {

// Light outside of a cut is extrapolated over so many slices, and by so much at most.
constexpr float kBeyond = 2, kMostGrowth = 4;
// Two values so near to each other count as one, in steps of the table: their difference would be mostly rounding.
constexpr float kSameValue = 0.05f;
// Rows are taken in parts of so many paths, in loops so simple that compilers vectorise them.
constexpr int kPart = 64;
using Part = float[kPart];

// Unlike std::min and std::max these take no references, which vectorisers do not see through.
UMBRICK_INLINE float lesser(float a, float b) { return a < b ? a : b; }
UMBRICK_INLINE float greater(float a, float b) { return a > b ? a : b; }

// Returns exp(-x) within 3e-7 of it for x in [-80, 80], 1 exactly at 0, and exp(-80) beyond.
UMBRICK_INLINE float expNegative(float x) {
  const float y = lesser(greater(x, -80.0f), 80.0f) * -1.44269504f;
  const auto whole = static_cast<std::int32_t>(y + 192.5f) - 192;  // rounded to the nearest
  const float f = (y - static_cast<float>(whole)) * 0.69314718f;   // in [-0.347, 0.347]
  const float p =
      1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
  return p * std::bit_cast<float>((whole + 127) << 23);
}

UMBRICK_INLINE void valuesAt(const PathRow& row, int first, int count, Part& values) {
  const float *near = row.near + first, *far = row.far + first;
  const float u = row.u, v = row.v;
  for (int i = 0; i < count; ++i) {
    const float left = near[i] + v * (far[i] - near[i]);
    const float right = near[i + 1] + v * (far[i + 1] - near[i + 1]);
    values[i] = left + u * (right - left);
  }
}

// Looks up the integral of sigma_t up to a value, and sigma_t at the value.
UMBRICK_INLINE void integralsAt(const PathMedium& medium, const Part& values, int count, Part& sums, Part& sigmas) {
  const float* table = medium.integrals;
  const float below = medium.below, above = medium.above;
  std::int32_t steps[kPart];
  for (int i = 0; i < count; ++i)
    steps[i] = static_cast<std::int32_t>(lesser(greater(values[i], 0.0f), static_cast<float>(ExtinctionTable::kSteps)));
  for (int i = 0; i < count; ++i) {
    sums[i] = table[steps[i]];
    sigmas[i] = table[steps[i] + 1];
  }
  // Beyond the table sigma_t is constant, and the same as in its first and last step.
  for (int i = 0; i < count; ++i) {
    const float inside = lesser(greater(values[i], 0.0f), static_cast<float>(ExtinctionTable::kSteps));
    const float rise = sigmas[i] - sums[i];
    sums[i] += (inside - static_cast<float>(steps[i])) * rise + lesser(values[i], 0.0f) * below +
               (greater(values[i], inside) - inside) * above;
    sigmas[i] = rise;
  }
}

// Returns the mean of sigma_t over values that run linearly.
UMBRICK_INLINE void meanExtinction(const PathMedium& medium, const Part& from, const Part& to, int count, Part& mean) {
  Part sumFrom, sumTo, sigma;
  integralsAt(medium, from, count, sumFrom, sigma);
  integralsAt(medium, to, count, sumTo, sigma);
  for (int i = 0; i < count; ++i) {
    const float change = to[i] - from[i];
    const float square = change * change;
    const float divisor = square < kSameValue * kSameValue ? 1.0f : change;
    const float ratio = (sumTo[i] - sumFrom[i]) / divisor;
    const float one = square < kSameValue * kSameValue ? sigma[i] : ratio;
    // Values at an end of the function have none, whatever the first step of the table has.
    const bool low = greater(from[i], to[i]) <= medium.emptyBelow, high = lesser(from[i], to[i]) >= medium.emptyAbove;
    mean[i] = low | high ? 0.0f : greater(one, 0.0f);
  }
}

// Tells whether no value of a part meets any medium.
UMBRICK_INLINE bool isEmpty(const PathMedium& medium, const Part& from, const Part& to, int count) {
  float low = from[0], high = from[0];
  for (int i = 0; i < count; ++i) {
    low = lesser(low, lesser(from[i], to[i]));
    high = greater(high, greater(from[i], to[i]));
  }
  return (high <= medium.emptyBelow) || (low >= medium.emptyAbove);
}

}  // namespace

UMBRICK_WIDE
void carryRow(const PathRow& before, const PathRow& here, const PathMedium& medium, float* depth, float* through,
              int count) {
  for (int first = 0; first < count; first += kPart) {
    const int part = count - first < kPart ? count - first : kPart;
    Part from, to, mean;
    valuesAt(before, first, part, from);
    valuesAt(here, first, part, to);
    float* after = depth + first;
    float* light = through + first;
    if (!isEmpty(medium, from, to, part)) {
      meanExtinction(medium, from, to, part, mean);
      const float length = medium.length;
      for (int i = 0; i < part; ++i) after[i] += length * mean[i];
    }
    for (int i = 0; i < part; ++i) light[i] = expNegative(after[i]);
  }
}

UMBRICK_WIDE
void carryCutRow(const PathRow& before, const PathRow& here, const PathMedium& medium, const RowPlane* planes,
                 int planeCount, float* depth, float* through, int count) {
  const float length = medium.length;
  for (int first = 0; first < count; first += kPart) {
    const int part = count - first < kPart ? count - first : kPart;
    // The medium is between `enter` and `leave`, in slices from this one on.
    Part enter, leave;
    for (int i = 0; i < part; ++i) {
      enter[i] = -1e9f;
      leave[i] = 1e9f;
    }
    for (int p = 0; p < planeCount; ++p) {
      const float rate = planes[p].rate, base = -planes[p].base / rate, step = -planes[p].step / rate;
      if (rate > 0)
        for (int i = 0; i < part; ++i) enter[i] = greater(enter[i], base + static_cast<float>(first + i) * step);
      else
        for (int i = 0; i < part; ++i) leave[i] = lesser(leave[i], base + static_cast<float>(first + i) * step);
    }
    Part from, to, begins, ends, mean, sums, sigmas;
    valuesAt(before, first, part, from);
    valuesAt(here, first, part, to);
    for (int i = 0; i < part; ++i) {
      const float begin = lesser(greater(enter[i], -1.0f), 0.0f), end = greater(lesser(leave[i], 0.0f), begin);
      const float last = to[i], change = last - from[i];
      begins[i] = last + begin * change;
      ends[i] = last + end * change;
      sums[i] = end - begin;
    }
    meanExtinction(medium, begins, ends, part, mean);
    float* after = depth + first;
    for (int i = 0; i < part; ++i) after[i] += length * sums[i] * mean[i];
    integralsAt(medium, to, part, sums, sigmas);
    for (int i = 0; i < part; ++i) {
      const float beyond = lesser(greater(0.0f, -leave[i]), kBeyond) - lesser(greater(0.0f, enter[i]), kBeyond);
      through[first + i] = expNegative(after[i] + greater(length * beyond * sigmas[i], -kMostGrowth));
    }
  }
}

UMBRICK_WIDE
void addRow(const float* __restrict before, const float* __restrict after, float u, float v, float weight,
            float* __restrict light, int count) {
  for (int i = 0; i < count; ++i) {
    const float left = after[i - 1] + v * (before[i - 1] - after[i - 1]);
    const float right = after[i] + v * (before[i] - after[i]);
    light[i] += weight * (right + u * (left - right));
  }
}

}  // namespace umbrick
