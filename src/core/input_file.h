// Which files are read as a header, a scene or the like, and which of those that such a file names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

namespace umbrick {

/// Checks that a path leads, links followed, to a file that has an end and lies in storage: no folder, pipe, socket or
/// device, which could go on for ever, and no file of /proc or /sys, which tells of the machine.
/// @return its size  @throw IoError
std::int64_t ordinaryFileSize(const std::filesystem::path& path);

/// Whether a file, links and ".." followed, lies in `folder` or below it. There may be no such file.
bool liesBelow(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Checks that a file lies beside or below the one that names it.
/// @param file  may be the same: it must not be a link that leads out of its folder
/// @throw IoError  it does not
void requireBeside(const std::filesystem::path& file, const std::filesystem::path& namedBy);

}  // namespace umbrick
