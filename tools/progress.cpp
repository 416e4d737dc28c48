// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "foreign_messages.h"
#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {

// A line that is longer than this would not be rewritten but repeated.
std::size_t terminalWidth() {
  winsize size{};
  const bool known = ioctl(messageDescriptor(), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)),
      pace_(progressStyle(std::getenv("UMBRICK_PROGRESS"), isatty(messageDescriptor()) == 1)) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
  if (drawn_) dprintf(messageDescriptor(), "\r\033[K");
  drawn_ = false;
}

void ProgressBar::begin(std::string label, double bytes) {
  label_ = std::move(label);
  bytes_ = bytes;
  part_ = Stopwatch();
  pace_.begin();
}

void ProgressBar::show(double share) { show(share, {}); }

void ProgressBar::show(double share, const std::string& step) {
  if (!pace_.isDue(job_.elapsedMs(), share)) return;
  std::string text = progressText(pace_.style(), label_, share, part_.elapsedMs(), bytes_);
  if (!step.empty()) text += "; " + step;
  if (pace_.style() == ProgressStyle::rewritten) {
    dprintf(messageDescriptor(), "\r\033[K%s", printable(text).substr(0, terminalWidth() - 1).c_str());
    drawn_ = true;
  } else {
    dprintf(messageDescriptor(), "%s\n", printable(text).c_str());
  }
}

std::function<void(double)> showShare(ProgressBar& bar, const StopRequest& stop, std::string interrupted) {
  return [&bar, &stop, interrupted = std::move(interrupted)](double share) {
    if (stop.requested()) throw Interrupted(interrupted);
    bar.show(share);
  };
}

}  // namespace umbrick::tools
