// SPDX-License-Identifier: Apache-2.0
#include "frame_words.h"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <regex>
#include <string_view>

#include "command.h"
#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace fs = std::filesystem;

FrameRange parseFrameRange(const std::string& text) {
  const auto refuse = [&] { throw UsageError("--frames: expected A, A-B or A-B:step with A <= B, found " + text); };
  std::string_view rest = text;
  const auto take = [&] {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc()) refuse();
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    return std::clamp<std::int64_t>(value, -1'000'000'000'000, 1'000'000'000'000);  // so that sums do not overflow
  };
  const auto follows = [&](char sign) {
    const bool found = rest.starts_with(sign);
    if (found) rest.remove_prefix(1);
    return found;
  };
  FrameRange range;
  range.first = range.last = take();
  if (follows('-')) range.last = take();
  if (follows(':')) range.step = take();
  if (!rest.empty() || range.last < range.first || range.step < 1) refuse();
  return range;
}

std::string rangesText(const std::vector<FrameRange>& ranges) {
  constexpr std::size_t kMostRanges = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMostRanges, ranges.size()); ++i) {
    const auto [first, last, step] = ranges[i];
    text += (i == 0 ? "" : ", ") + std::to_string(first) + (last > first ? " to " + std::to_string(last) : "");
  }
  return text + (ranges.size() > kMostRanges ? ", ..." : "");
}

std::vector<FrameRange> rangesOf(const std::vector<std::int64_t>& numbers, std::int64_t step) {
  std::vector<FrameRange> ranges;
  for (const std::int64_t number : numbers) {
    if (!ranges.empty() && ranges.back().last + step == number)
      ranges.back().last = number;
    else
      ranges.push_back({number, number, step});
  }
  return ranges;
}

std::string missingText(const std::vector<FrameRange>& missing) {
  std::int64_t count = 0;
  for (const auto& [first, last, step] : missing) count += (last - first) / step + 1;
  if (count == 0) return {};
  return std::to_string(count) + (count == 1 ? " frame is" : " frames are") + " missing: " + rangesText(missing);
}

void tellMissing(const fs::path& pattern, const std::vector<FrameRange>& missing) {
  if (const std::string text = missingText(missing); !text.empty())
    std::cerr << printable(pattern.string()) << ": " << text << '\n';
}

void refuseSeveralNumbers(const fs::path& path) {
  static const std::regex number("%0?[0-9]*d");
  const std::string name = path.filename().string();
  const auto count = std::distance(std::sregex_iterator(name.begin(), name.end(), number), std::sregex_iterator());
  std::error_code none;
  if (count > 1 && !fs::exists(path, none))
    throw UsageError(path.string() + ": expected one number in the name, as frame_%04d, found " +
                     std::to_string(count));
}

}  // namespace umbrick::tools
