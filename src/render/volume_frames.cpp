// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/volume_frames.h"

#include <chrono>
#include <utility>

#include "umbrick/core/stopwatch.h"
#include "umbrick/ingest/volume_parts.h"

namespace umbrick {

VolumeFrames::VolumeFrames(std::vector<VolumeReference> files, Cut cut)
    : files_(std::move(files)), cut_(std::move(cut)), kept_(keepStream()) {
  begin();
}

VolumeFrames::~VolumeFrames() {
  ends_ = true;  // for which the future waits
}

void VolumeFrames::begin() {
  if (done()) return;
  reading_ = std::async(std::launch::async, [this, index = given_] {
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
  while (reading_.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
    if (waiting) waiting();
  std::future<VolumeFrame> ready = std::move(reading_);
  ++given_;
  begin();
  return ready.get();
}

}  // namespace umbrick
