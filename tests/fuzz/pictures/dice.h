// Random choices for scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>

#include "umbrick/core/random.h"

namespace umbrick {

class Dice {
 public:
  explicit Dice(std::uint64_t seed, std::uint64_t stream = 0) : random_(seed, stream) {}
  double uniform() { return random_.uniform(); }  // in (0, 1)
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Its logarithm is uniform: each power of ten is as likely as another.
  double scaleBetween(double low, double high) { return low * std::pow(high / low, uniform()); }
  int below(int count) { return std::min(count - 1, static_cast<int>(uniform() * count)); }
  int whole(int low, int high) { return low + below(high - low + 1); }
  bool chance(double probability) { return uniform() < probability; }
  template <class T>
  T of(std::initializer_list<T> choices) {
    return choices.begin()[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
  }
  glm::dvec3 point(const glm::dvec3& low, const glm::dvec3& high) {
    const double x = uniform(), y = uniform(), z = uniform();  // in this order
    return low + (high - low) * glm::dvec3(x, y, z);
  }
  /// Of unit length, all alike.
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 p = point(glm::dvec3(-1), glm::dvec3(1));
      const double length = glm::length(p);
      if (length > 0.1 && length < 1) return p / length;
    }
  }

 private:
  Random random_;
};

}  // namespace umbrick
