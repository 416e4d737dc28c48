// SPDX-License-Identifier: Apache-2.0
#include "core/text_file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "core/input_file.h"
#include "umbrick/core/error.h"

namespace umbrick {

std::string readTextFile(const std::filesystem::path& path) {
  constexpr std::int64_t kMostBytes = std::int64_t(1) << 30;
  const std::int64_t bytes = ordinaryFileSize(path);
  if (bytes > kMostBytes)
    throw IoError(path.string() + ": expected a text of at most " + std::to_string(kMostBytes) + " bytes, found " +
                  std::to_string(bytes));
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path.string() + ": cannot read: " + std::strerror(errno));
  std::string text(static_cast<std::size_t>(bytes), '\0');
  in.read(text.data(), bytes);
  if (in.bad()) throw IoError(path.string() + ": cannot read: " + std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace umbrick
