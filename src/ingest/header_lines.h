// The lines of text at the head of a file that may go on with binary voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace umbrick {

class HeaderLines {
 public:
  /// @param mostLine  a longer line ends the reading: a file of voxels need not have any end of line
  /// @throw IoError  the file cannot be opened
  explicit HeaderLines(const std::filesystem::path& path, std::size_t mostLine = std::numeric_limits<int>::max());

  /// The next line, without its end ("\n" or "\r\n"). @return false behind the last one
  /// @throw IoError  the line or the header is too long
  bool next(std::string& text);
  /// All lines that are left, trimmed, but for blank ones.
  std::vector<std::string> rest();
  /// Bytes of the lines that were read, with their ends: where the voxels begin when they follow.
  std::int64_t bytes() const { return bytes_; }

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  std::size_t mostLine_;
  std::int64_t bytes_ = 0;
};

}  // namespace umbrick
