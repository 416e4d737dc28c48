// Bands of a picture's rows whose bricks fit into memory together.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace umbrick {

/// The rows of a picture that a brick is seen in; none where first > last.
struct RowSpan {
  int first = 0, last = -1;
  bool meets(int begin, int end) const { return first < end && last >= begin; }
};

/// Rows begin <= row < end.
struct RowBand {
  int begin = 0, end = 0;
};

/// Cuts rows into as few bands as go from the first to the last with bricks that fit.
/// @param bricks    where each is seen
/// @param rows      of the picture
/// @param multiple  bands begin at multiples of it
/// @param each      bytes of a brick
/// @throw InvalidArgument  the bricks of the least band take more than `most` bytes
std::vector<RowBand> cutBands(std::span<const RowSpan> bricks, int rows, int multiple, std::uint64_t each,
                              std::uint64_t most);

}  // namespace umbrick
