// Runs of slices whose bricks fit the atlas together.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Slices [first, last) and the bricks they need, ascending.
struct SweepRun {
  std::int64_t first = 0, last = 0;
  std::vector<std::int32_t> bricks;
};

/// Cuts the sweep into as few runs as the atlas allows. A run of one slice may still need more bricks than `slots`,
/// which the atlas then reports.
/// @param sweeps  all with the same number of slices: a run has the bricks that any of them needs
/// @param slots  number of bricks that fit at once; runs end before they need more
std::vector<SweepRun> planSweep(std::span<const ProxySlices* const> sweeps, std::size_t bricks, std::size_t slots);

}  // namespace umbrick
