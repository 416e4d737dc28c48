// A whole text file in memory.
#pragma once
#include <filesystem>
#include <string>

namespace umbrick {

/// @throw IoError  missing, a folder, or unreadable
std::string readTextFile(const std::filesystem::path& path);

}  // namespace umbrick
