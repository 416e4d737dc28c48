// What a file holds from which one volume is picked by name: datasets of HDF5, arrays of VTK images.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace umbrick {

struct ArrayRow {
  std::string name;     // behind the colon, as in file.h5:/name or file.vti:name
  std::string shape;    // the axes as the file has them, and what they are of: "3 x 4 x 6", "72 points"
  std::string type;     // "f32", "3 x f32", or what it is that is not read
  bool volume = false;  // whether it can be opened as a volume
};

/// Lists the datasets or arrays of a file in the order of the file. Nothing for a file of another format, or for one
/// that `path` picks already.
/// @throw IoError  the file cannot be read, or is damaged
std::vector<ArrayRow> listArrays(const std::filesystem::path& path);

}  // namespace umbrick
