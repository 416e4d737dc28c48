// SPDX-License-Identifier: Apache-2.0
#include "progress_pace.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace umbrick::tools {
namespace {

// What is shorter than the first wait says nothing.
constexpr double kFirstLineMs = 10'000, kNextLineMs = 30'000;
constexpr double kFirstBarMs = 400, kNextBarMs = 200;

bool hasPassed(double elapsedMs, double saidMs, double first, double next) {
  return saidMs < 0 ? elapsedMs >= first : elapsedMs - saidMs >= next;
}

}  // namespace

ProgressStyle progressStyle(const char* wish, bool terminal) {
  const std::string_view asked = wish ? wish : "";
  if (asked == "none") return ProgressStyle::none;
  if (asked == "steps") return ProgressStyle::steps;
  return terminal ? ProgressStyle::rewritten : ProgressStyle::lines;
}

bool ProgressPace::isDue(double elapsedMs, double share) {
  const int tenths = static_cast<int>(10 * share);
  bool due = false;
  switch (style_) {
    case ProgressStyle::none:
      break;
    case ProgressStyle::rewritten:
      due = hasPassed(elapsedMs, saidMs_, kFirstBarMs, kNextBarMs);
      break;
    case ProgressStyle::lines:
      due = hasPassed(elapsedMs, saidMs_, kFirstLineMs, kNextLineMs);
      break;
    case ProgressStyle::steps:
      due = tenths > tenths_;
      break;
  }
  if (!due) return false;
  saidMs_ = elapsedMs;
  tenths_ = tenths;
  return true;
}

std::string minutes(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  char text[32];
  if (whole >= 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

std::string progressText(ProgressStyle style, const std::string& label, double share, double elapsedMs, double bytes) {
  share = std::clamp(share, 0.0, 1.0);
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100 * share);
  std::string text = label;
  if (style == ProgressStyle::rewritten) {
    constexpr std::size_t kWidth = 30;
    const auto filled = static_cast<std::size_t>(share * kWidth);
    text += " [" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] " + percent;
  } else {
    text += ": " + std::string(percent).substr(std::string(percent).find_first_not_of(' '));
  }
  if (bytes > 0 && elapsedMs > 0 && share > 0)
    text += ", " + std::to_string(std::lround(share * bytes / elapsedMs / 1000)) + " MB/s";
  // Before a hundredth is done, an estimate would be off by too much.
  if (share >= 0.01) text += ", " + minutes(elapsedMs / 1000 * (1 - share) / share) + " left";
  return text;
}

}  // namespace umbrick::tools
