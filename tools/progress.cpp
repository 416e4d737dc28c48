// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <utility>

namespace umbrick::tools {
namespace {

// A signal handler can only reach a static variable.
volatile std::sig_atomic_t stopRequested = 0;
// Asks the job to stop, and lets the next signal end the program as the first one would have ended it.
void requestStop(int number) {
  stopRequested = 1;
  std::signal(number, SIG_DFL);
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

}  // namespace

StopRequest::StopRequest() {
  stopRequested = 0;
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
}

StopRequest::~StopRequest() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool StopRequest::requested() const { return stopRequested != 0; }

ProgressBar::ProgressBar(std::string label) : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void ProgressBar::begin(std::string label, double bytes) {
  label_ = std::move(label);
  bytes_ = bytes;
  start_ = Stopwatch();
  shownMs_ = -1e9;
}

void ProgressBar::show(double share) {
  const double elapsed = start_.elapsedMs();
  if (!terminal_ || elapsed - shownMs_ < 200) return;
  shownMs_ = elapsed;
  drawn_ = true;
  constexpr int width = 30;
  const int filled = static_cast<int>(share * width);
  const std::string bar =
      std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(width - filled), '.');
  std::string rate;
  if (bytes_ > 0 && elapsed > 0) rate = std::to_string(std::lround(share * bytes_ / elapsed / 1000)) + " MB/s  ";
  const std::string left = share > 0 ? minutes(elapsed / 1000 * (1 - share) / share) + " left" : "";
  std::fprintf(stderr, "\r\033[K%s [%s] %3.0f %%  %s%s", label_.c_str(), bar.c_str(), 100 * share, rate.c_str(),
               left.c_str());
  std::fflush(stderr);
}

}  // namespace umbrick::tools
