// Which parts of bricks show something: so that rays skip what is empty within a brick.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "umbrick/brick/bricks.h"

namespace umbrick {

/// Ranges of parts of bricks, read from the volume once, whatever the transfer function is.
class BrickParts {
 public:
  /// Voxels along the edge of a part: small beside what is usually solid or empty, and large beside an apron.
  static constexpr int kEdge = 8;
  /// @param volume  outlives this
  explicit BrickParts(const Bricks& volume);

  /// Tells whether bricks have more than one part.
  bool divides() const { return perBrick() > 1; }
  glm::ivec3 edge() const { return volume_.layout.interior / count_; }  // voxels
  glm::ivec3 count() const { return count_; }                           // parts of a brick along each axis
  std::size_t perBrick() const {
    return static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) * static_cast<std::size_t>(count_.z);
  }

  /// Reads the bricks at these origins that were not read yet.
  void read(std::span<const glm::ivec3> origins);
  /// Calls visit(part, values, gradients, emission) for the parts of a brick, x fastest. As those of bricks do, ranges
  /// count what an apron around the part holds. @pre divides(), and the brick was read
  void each(const glm::ivec3& origin,
            const std::function<void(std::size_t part, const Range& value, const Range& gradient,
                                     const Range& emission)>& visit) const;

 private:
  struct Ranges {
    Range value, gradient, emission;
  };
  struct Hash {
    std::size_t operator()(const glm::ivec3& o) const;
  };
  void measure(std::span<const float> values, std::vector<Range>& ranges) const;
  std::vector<Ranges> rangesOf(const glm::ivec3& origin) const;
  const Bricks& volume_;
  glm::ivec3 count_;
  std::unordered_map<glm::ivec3, std::vector<Ranges>, Hash> bricks_;
};

}  // namespace umbrick
