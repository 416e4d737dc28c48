#include "shade/sweep_plan.h"

#include <algorithm>

namespace umbrick {

std::vector<SweepRun> planSweep(const ProxySlices& slices, std::size_t bricks, std::size_t slots) {
  std::vector<SweepRun> runs;
  std::vector<std::int64_t> usedIn(bricks, -1);  // the run that lists the brick last
  SweepRun run;
  const auto close = [&](std::int64_t last) {
    run.last = last;
    std::sort(run.bricks.begin(), run.bricks.end());
    runs.push_back(std::move(run));
    run = {last, last, {}};
  };
  for (std::int64_t i = 0; i < slices.count(); ++i) {
    const auto polygons = std::span(slices.polygons)
                              .subspan(static_cast<std::size_t>(slices.start[static_cast<std::size_t>(i)]),
                                       static_cast<std::size_t>(slices.start[static_cast<std::size_t>(i) + 1] -
                                                                slices.start[static_cast<std::size_t>(i)]));
    const auto isNew = [&](const ProxyPolygon& polygon) {
      return usedIn[static_cast<std::size_t>(polygon.brick)] != static_cast<std::int64_t>(runs.size());
    };
    const auto added = static_cast<std::size_t>(std::count_if(polygons.begin(), polygons.end(), isNew));
    if (!run.bricks.empty() && run.bricks.size() + added > slots) close(i);
    for (const ProxyPolygon& polygon : polygons)
      if (isNew(polygon)) {
        usedIn[static_cast<std::size_t>(polygon.brick)] = static_cast<std::int64_t>(runs.size());
        run.bricks.push_back(polygon.brick);
      }
  }
  if (slices.count() > 0) close(slices.count());
  return runs;
}

}  // namespace umbrick
