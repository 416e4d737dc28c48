// The files of a stack of images.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace umbrick {

/// The files that `path` stands for, in the order of their slices: an image, a pattern of numbered names, names with *
/// or ?, or a folder. Hidden files, whose names begin with a dot, are no images of a folder.
/// @param notes  gets a line for each file that is left out  @throw IoError  none, or numbers that do not follow each
///               other
std::vector<std::filesystem::path> sliceFiles(const std::filesystem::path& path, std::vector<std::string>& notes);

}  // namespace umbrick
