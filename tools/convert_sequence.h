// Sequences: one output for each of many numbered inputs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convert_options.h"
#include "umbrick/grid/build_grid.h"

namespace umbrick::tools {

/// What a frame is read from and written to.
struct FrameFiles {
  std::int64_t number = 0;
  std::filesystem::path input, output;
};

/// The frames, in ascending order, where input and output have a number in their names; none where neither has, or
/// where the input is a stack of images. Says on stderr which numbers are missing between the first and the last.
/// @throw UsageError  one of both has a number and the other has not, several inputs, or frames that are single images
/// @throw IoError     there is no such frame
std::vector<FrameFiles> findFrames(const ConvertOptions& options);

/// The options for one frame: its files, and a mask of its number where masks are numbered.
ConvertOptions frameOptions(const ConvertOptions& options, const FrameFiles& frame);

/// Calls `convert` for one frame after the other; an error that it meets names the frame and ends the run.
/// @throw Error
void forFrames(const std::vector<FrameFiles>& frames, const std::function<void(std::size_t)>& convert);

/// One line about a frame that is written, on stdout.
/// @param bytes          of the output
/// @param levelSetError  of isosurfaces, voxels, which counts in place of that of values
/// @param extras         put behind, such as ", verified"
void printFrame(const FrameFiles& frame, const std::vector<BuildReport>& reports, std::int64_t bytes,
                std::optional<double> levelSetError, const std::string& extras);

}  // namespace umbrick::tools
