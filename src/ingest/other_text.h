// What is said of text that is not what a file of a format has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

/// Like failField() of header_text.h, but the text is not quoted: the file may be any, a private one that a header of a
/// stranger names. @throw IoError  "path: field: expected ..., found other text"
[[noreturn]] inline void failText(const std::filesystem::path& path, const std::string& field,
                                  const std::string& expected) {
  throw IoError(path.string() + ": " + field + ": expected " + expected + ", found other text");
}

}  // namespace umbrick
