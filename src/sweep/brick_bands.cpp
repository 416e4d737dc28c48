// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_bands.h"

#include <algorithm>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

std::vector<RowBand> cutBands(std::span<const RowSpan> bricks, int rows, int multiple, std::uint64_t each,
                              std::uint64_t most) {
  // How many bricks begin in each group of rows, and how many are seen in it.
  const int groups = (rows + multiple - 1) / multiple;
  std::vector<std::uint64_t> begin(static_cast<std::size_t>(groups) + 1), seen(begin.size() + 1);
  for (const RowSpan& brick : bricks) {
    if (!brick.meets(0, rows)) continue;
    const auto first = static_cast<std::size_t>(std::max(brick.first, 0) / multiple);
    const auto last = static_cast<std::size_t>(std::min(brick.last, rows - 1) / multiple);
    ++begin[first];
    ++seen[first];
    --seen[last + 1];
  }
  for (std::size_t i = 1; i < seen.size(); ++i) seen[i] += seen[i - 1];
  std::vector<RowBand> bands;
  for (int first = 0; first < groups;) {
    std::uint64_t held = seen[static_cast<std::size_t>(first)];
    if (held * each > most)
      throw InvalidArgument("bricks.budgetMiB: the " + std::to_string(held) + " bricks that row " +
                            std::to_string(first * multiple) + " of the picture sees take " +
                            std::to_string((held * each >> 20) + 1) + " MiB, more than " + std::to_string(most >> 20) +
                            " MiB");
    int next = first + 1;
    while (next < groups && (held + begin[static_cast<std::size_t>(next)]) * each <= most)
      held += begin[static_cast<std::size_t>(next++)];
    bands.push_back({first * multiple, std::min(next * multiple, rows)});
    first = next;
  }
  return bands;
}

}  // namespace umbrick
