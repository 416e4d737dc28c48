// A float image in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

namespace umbrick {

/// An image of width x height pixels of `channels` interleaved floats. Row 0 is the bottom row.
/// Colour is linear and premultiplied.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 4;
  std::vector<float> pixels;

  Image() = default;
  Image(int w, int h, int c = 4)
      : width(w),
        height(h),
        channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

  float* at(int x, int y) { return pixels.data() + offset(x, y); }
  const float* at(int x, int y) const { return pixels.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

}  // namespace umbrick
