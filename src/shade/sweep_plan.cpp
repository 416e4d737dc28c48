// SPDX-License-Identifier: Apache-2.0
#include "shade/sweep_plan.h"

#include <algorithm>

namespace umbrick {

std::vector<SweepRun> planSweep(std::span<const ProxySlices* const> sweeps, std::size_t bricks, std::size_t slots) {
  std::vector<SweepRun> runs;
  std::vector<std::int64_t> usedIn(bricks, -1);  // the run that lists the brick last
  std::vector<std::int64_t> seenIn(bricks, -1);  // the slice that lists the brick last
  SweepRun run;
  const auto close = [&](std::int64_t last) {
    run.last = last;
    std::sort(run.bricks.begin(), run.bricks.end());
    runs.push_back(std::move(run));
    run = {last, last, {}};
  };
  const std::int64_t count = sweeps.empty() ? 0 : sweeps.front()->count();
  std::vector<std::int32_t> needed;
  for (std::int64_t i = 0; i < count; ++i) {
    needed.clear();
    for (const ProxySlices* slices : sweeps)
      for (std::int32_t p = slices->start[static_cast<std::size_t>(i)];
           p < slices->start[static_cast<std::size_t>(i) + 1]; ++p) {
        const std::int32_t brick = slices->polygons[static_cast<std::size_t>(p)].brick;
        if (seenIn[static_cast<std::size_t>(brick)] != i) needed.push_back(brick);
        seenIn[static_cast<std::size_t>(brick)] = i;
      }
    const auto isNew = [&](std::int32_t brick) {
      return usedIn[static_cast<std::size_t>(brick)] != static_cast<std::int64_t>(runs.size());
    };
    const auto added = static_cast<std::size_t>(std::count_if(needed.begin(), needed.end(), isNew));
    if (!run.bricks.empty() && run.bricks.size() + added > slots) close(i);
    for (const std::int32_t brick : needed)
      if (isNew(brick)) {
        usedIn[static_cast<std::size_t>(brick)] = static_cast<std::int64_t>(runs.size());
        run.bricks.push_back(brick);
      }
  }
  if (count > 0) close(count);
  return runs;
}

}  // namespace umbrick
