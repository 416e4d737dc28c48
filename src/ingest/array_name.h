// Arrays of a file by name: "file.vti:pressure".
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace umbrick {

struct NamedArray {
  std::filesystem::path file;
  std::string array;  // empty: none was named
};

/// Parts "file.vti:name" where `file.vti` is a file and `path` is none. @param extension  ".vti"
NamedArray splitArrayName(const std::filesystem::path& path, std::string_view extension);

}  // namespace umbrick
