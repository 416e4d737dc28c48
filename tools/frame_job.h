// The frames of a sequence, and the pictures that umbrick render makes of them: which, and where each of them goes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render_command.h"

namespace umbrick::tools {

struct FrameJob {
  struct Frame {
    std::int64_t number = 0;
    VolumeReference volume;
    double turn = 0;                                   // share of the orbit, in [0, 1)
    std::vector<std::filesystem::path> pictures = {};  // numbered files, and streams
    std::filesystem::path stats = {};                  // empty: has none of its own
    bool finished = false;                             // all of its files are there, and stay
  };
  std::vector<Frame> frames;            // in ascending order, at least one
  bool oneVolume = false;               // all frames show the same volume
  std::int64_t step = 1;                // between numbers
  bool skipMissing = false;             // frames that cannot be read are left out
  std::vector<std::string> notes = {};  // lines on what is missing or left out
  std::vector<std::filesystem::path> films;
  std::filesystem::path stats;  // of all frames together; empty: none
};

/// Finds the frames of a volume that is a pattern of numbered files, or one file of several volumes; nothing where it
/// is neither. Pictures have no places yet.
/// @param one  one frame of the file was chosen
/// @throw UsageError  the range cannot be read
/// @throw Error       there is no frame, or some are missing that are not to be skipped
std::optional<FrameJob> findSequence(const VolumeReference& volume, bool one, const FrameOptions& options);

/// Finds the frames of a command; nothing where it asks for one picture. Says on stderr which frames are missing, and
/// which are there already.
/// @param scene  as askedScene() makes it
/// @throw UsageError  an output that has no place for many pictures; frames of what has none
/// @throw Error       frames are missing that are not to be skipped; an output cannot be written
std::optional<FrameJob> findFrameJob(const RenderCommand& command, const Scene& scene);

}  // namespace umbrick::tools
