// A whole text file in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

namespace umbrick {

/// @throw IoError  the file is missing, a folder, a pipe or device, unreadable, or longer than 1 GiB
std::string readTextFile(const std::filesystem::path& path);

}  // namespace umbrick
