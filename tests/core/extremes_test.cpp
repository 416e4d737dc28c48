// SPDX-License-Identifier: Apache-2.0
#include "core/extremes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "core/large_vector.h"
#include "umbrick/core/random.h"

using namespace umbrick;

TEST_CASE("The least and the largest number are those of std::minmax_element, wherever they stand", "[core]") {
  Random random(3, 0);
  for (const std::size_t count : {1, 2, 15, 16, 17, 31, 33, 100}) {
    std::vector<float> numbers(count);
    for (float& number : numbers) number = static_cast<float>(random.uniform() - 0.5);
    for (std::size_t place = 0; place < count; ++place) {
      std::vector<float> peaked = numbers;
      peaked[place] = place % 2 == 0 ? 7.0f : -7.0f;
      const auto [least, most] = std::ranges::minmax(peaked);
      CHECK(leastAndMost(peaked) == std::pair(least, most));
    }
  }
}

TEST_CASE("What is no number is neither the least nor the largest", "[core]") {
  std::vector<float> numbers(40, 1.0f);
  numbers[20] = numbers[39] = std::numeric_limits<float>::quiet_NaN();
  numbers[8] = -std::numeric_limits<float>::infinity();
  CHECK(leastAndMost(numbers) == std::pair(-std::numeric_limits<float>::infinity(), 1.0f));
}

TEST_CASE("Large vectors hold what they are given, and small ones do, too", "[core]") {
  for (const std::size_t count : {std::size_t{1}, std::size_t{1} << 10, std::size_t{3} << 20}) {
    LargeVector<std::uint32_t> numbers(count);
    CHECK(std::ranges::all_of(numbers, [](std::uint32_t each) { return each == 0; }));
    for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(i);
    LargeVector<std::uint32_t> copy = numbers;
    copy.push_back(5);  // moves to other memory
    CHECK(copy.size() == count + 1);
    CHECK(std::equal(numbers.begin(), numbers.end(), copy.begin()));
  }
  CHECK_THROWS_AS(LargeVector<std::uint32_t>().reserve(std::size_t{1} << 63), std::length_error);
}
