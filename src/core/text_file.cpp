// SPDX-License-Identifier: Apache-2.0
#include "core/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "umbrick/core/error.h"

namespace umbrick {

std::string readTextFile(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw IoError(path.string() + ": cannot read: is a directory");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path.string() + ": cannot read: " + std::strerror(errno));
  std::ostringstream text;
  text << in.rdbuf();
  // Reading an empty file inserts nothing, which sets failbit but is no error here.
  if (in.bad()) throw IoError(path.string() + ": cannot read: " + std::strerror(errno));
  return std::move(text).str();
}

}  // namespace umbrick
