// The frames of a sequence: volumes in numbered files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace umbrick {

struct NumberedFile {
  std::int64_t number = 0;
  std::filesystem::path path;
};

/// True where the name has one %d, %4d or %04d and nothing is called just that. Folders do not count, nor does what
/// stands behind the name of an HDF5 file: "run/file_%04d.h5:/density" is a pattern.
bool isFramePattern(const std::filesystem::path& path);

/// The path of one frame. @pre isFramePattern(pattern), or the only reason against it is a file of that very name
std::filesystem::path framePath(const std::filesystem::path& pattern, std::int64_t number);

/// The files and folders whose names fit a pattern, in ascending order of their numbers, of which some may be missing.
/// Numbers may be negative, and written in another width than the pattern has: frame_9 and frame_009 fit frame_%04d.
/// @param leftOut  gets files whose number another file has, which fits the pattern better, or is too large; may be
/// null
/// @throw IoError  there is none, or a folder that cannot be read  @throw InvalidArgument  not a pattern
std::vector<NumberedFile> listFrames(const std::filesystem::path& pattern,
                                     std::vector<std::filesystem::path>* leftOut = nullptr);

}  // namespace umbrick
