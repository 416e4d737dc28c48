// SPDX-License-Identifier: Apache-2.0
#include "ingest/volume_time.h"

#include <algorithm>
#include <cmath>

#include "umbrick/core/short_number.h"

namespace umbrick {
namespace {

constexpr int kTimeDigits = 15;  // a number with fewer in the file comes out as it stands there

// Returns the distance of times that lie evenly, and else nothing.
std::optional<double> evenStep(const std::vector<double>& times) {
  if (times.size() < 2) return {};
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(std::abs(times[i] - times[i - 1] - step) <= 1e-6 * std::abs(step))) return {};
  return step;
}

}  // namespace

void stateTime(VolumeInfo& info, const VolumeTimes& times, std::optional<std::int64_t> frame) {
  if (info.frames > 1 && frame) info.metadata["frame"] = std::to_string(*frame);
  const std::int64_t number = frame.value_or(0);
  const std::optional<double> step = times.each.empty() ? times.step : evenStep(times.each);
  std::optional<double> time;
  if (number >= 0 && static_cast<std::size_t>(number) < times.each.size())
    time = times.each[static_cast<std::size_t>(number)];
  else if (times.each.empty() && (times.first || (times.step && info.frames > 1)))
    time = times.first.value_or(0) + static_cast<double>(number) * times.step.value_or(0);
  const auto keep = [&](const char* key, const std::optional<double>& value) {
    if (value && std::isfinite(*value)) info.metadata[key] = shortNumber(*value, kTimeDigits);
  };
  keep("time", time);
  if (info.frames > 1 || times.each.empty()) keep("time_step", step);
  const bool known = info.metadata.contains("time") || info.metadata.contains("time_step");
  if (known && !times.unit.empty()) info.metadata["time_unit"] = times.unit;
}

}  // namespace umbrick
