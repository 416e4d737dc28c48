// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/volume_frames.h"

#include <chrono>
#include <utility>

#include "umbrick/core/stopwatch.h"
#include "umbrick/ingest/volume_parts.h"

namespace umbrick {

VolumeFrames::VolumeFrames(std::vector<VolumeReference> files, Cut cut, Pick pick)
    : files_(std::move(files)), cut_(std::move(cut)), pick_(std::move(pick)), kept_(keepStream()) {
  if (!pick_) pick_ = [this](bool) { return done() ? std::nullopt : std::optional(given_); };
  begin(false);
}

VolumeFrames::~VolumeFrames() {
  ends_ = true;  // for which the future waits
}

std::optional<std::size_t> VolumeFrames::upcoming() {
  if (!upcoming_) begin(false);
  return upcoming_;
}

void VolumeFrames::begin(bool ahead) {
  upcoming_ = pick_(ahead);
  if (!upcoming_) return;
  reading_ = std::async(std::launch::async, [this, index = *upcoming_] {
    const VolumeReference& file = files_[index];
    VolumeFrame frame;
    // Only frames of one file go on where the one before ended.
    const bool inside = files_.size() > 1 && files_[0].file == files_[1].file;
    const auto look = [this](double) {
      if (ends_) throw Error("the frame is not wanted any more");
    };
    try {
      frame.volume = std::make_shared<const Volume>(file, look, inside ? kept_ : nullptr);
    } catch (const EmptyVolume&) {
      return frame;
    }
    const Stopwatch brick;
    frame.bricks = cut_(*frame.volume, index);
    frame.brickMs = brick.elapsedMs();
    return frame;
  });
}

VolumeFrame VolumeFrames::next(const std::function<void()>& waiting) {
  upcoming();
  while (reading_.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
    if (waiting) waiting();
  std::future<VolumeFrame> ready = std::move(reading_);
  ++given_;
  begin(true);
  return ready.get();
}

}  // namespace umbrick
