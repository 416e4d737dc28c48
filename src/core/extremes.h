// The least and the largest of many numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace umbrick {

/// Returns both; NaN counts for nothing. Several numbers are compared at a time, as compilers do not with
/// std::minmax_element: of voxels that takes as long as reading them.
/// @param numbers  one or more
inline std::pair<float, float> leastAndMost(std::span<const float> numbers) {
  constexpr std::size_t kTogether = 16;
  std::array<float, kTogether> least, most;
  least.fill(numbers.front());
  most.fill(numbers.front());
  const auto compare = [&](std::size_t lane, float number) {
    least[lane] = number < least[lane] ? number : least[lane];
    most[lane] = number > most[lane] ? number : most[lane];
  };
  std::size_t i = 0;
  for (; i + kTogether <= numbers.size(); i += kTogether)
    for (std::size_t lane = 0; lane < kTogether; ++lane) compare(lane, numbers[i + lane]);
  for (; i < numbers.size(); ++i) compare(0, numbers[i]);
  std::pair<float, float> both(least[0], most[0]);
  for (std::size_t lane = 1; lane < kTogether; ++lane) {
    both.first = least[lane] < both.first ? least[lane] : both.first;
    both.second = most[lane] > both.second ? most[lane] : both.second;
  }
  return both;
}

}  // namespace umbrick
