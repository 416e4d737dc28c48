// The mean of pictures of one scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <vector>

#include "umbrick/draw/renderer.h"

namespace umbrick {

/// The mean of the colours of pictures alone, which takes half the memory of all that they hold.
class ColourMean {
 public:
  void add(const Image& colour);
  /// @param i  of the numbers of a picture, channel by channel of a pixel
  double operator[](std::size_t i) const { return sum_[i] / count_; }
  std::size_t values() const { return sum_.size(); }

 private:
  int count_ = 0;
  std::vector<double> sum_;
};

/// A sum of pictures, from which their mean is taken.
class PictureMean {
 public:
  void add(const Picture& picture);
  std::size_t values() const { return colour_.values(); }
  /// Replaces the pixels of a picture of the same size by the means. Depth is averaged by opacity, and further layers
  /// over the pictures in which a pixel has a number.
  void store(Picture& picture) const;

 private:
  int count_ = 0;
  ColourMean colour_;
  std::vector<double> visibility_, opacity_;
  std::vector<double> depth_;  // sum of depths weighted by opacity
  struct LayerSum {
    std::vector<double> sum;
    std::vector<int> count;  // of finite numbers
  };
  std::vector<LayerSum> layers_;
};

}  // namespace umbrick
