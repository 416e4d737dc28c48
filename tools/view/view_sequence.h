// The frames of a sequence that pages look at.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/render/volume.h"

namespace umbrick::view {

struct ViewSequence {
  struct Frame {
    std::int64_t number = 0;
    VolumeReference volume;
  };
  std::vector<Frame> frames;  // in ascending order of their numbers, at least one
  std::int64_t step = 1;      // between numbers, of which some may be missing
  VolumeReference whole;      // what a scene of all frames names: a pattern, or a file of several volumes
  bool inside = false;        // the frames are volumes of one file
  std::optional<Box> seen;    // what an orbit looks at, whichever frame is shown; none: what the first one shows
  std::size_t first = 0;      // the frame that is shown first
  /// Throws InvalidArgument where a frame cannot be shown as the first one is; may be empty.
  std::function<void(const Volume&)> check;
  std::shared_ptr<const void> keeps = {};  // what has to be there while frames are read
};

/// Returns which frame has a number; none where there is no such frame.
std::optional<std::size_t> frameOf(const ViewSequence& sequence, std::int64_t number);

/// Returns what a scene of one frame names. @param volume  of the frame; null: it holds nothing
VolumeReference sourceOf(const ViewSequence& sequence, std::size_t index, const Volume* volume);

/// Returns the options of umbrick render that pick the frames: "--frames 1-24", "--frames 0-20:2 --skip-missing".
std::string frameOptions(const ViewSequence& sequence);

}  // namespace umbrick::view
