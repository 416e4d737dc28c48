// SPDX-License-Identifier: Apache-2.0
#include "core/input_file.h"

#include <linux/magic.h>
#include <sys/vfs.h>

#include <algorithm>
#include <system_error>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

std::string kindOf(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a directory";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

// What lies there is made by the kernel at the moment it is read.
bool isOfKernel(const fs::path& path) {
  struct statfs found {};
  if (statfs(path.c_str(), &found) != 0) return false;
  return found.f_type == PROC_SUPER_MAGIC || found.f_type == SYSFS_MAGIC;
}

}  // namespace

std::int64_t ordinaryFileSize(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error) throw IoError(path.string() + ": cannot read: " + error.message());
  if (status.type() != fs::file_type::regular)
    throw IoError(path.string() + ": cannot read: is " + kindOf(status.type()));
  if (isOfKernel(path)) throw IoError(path.string() + ": cannot read: is made up by the system, as those of /proc");
  const auto size = fs::file_size(path, error);
  if (error) throw IoError(path.string() + ": cannot read: " + error.message());
  return static_cast<std::int64_t>(size);
}

bool liesBelow(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(file, error);
  if (error) return false;
  const fs::path top = fs::canonical(folder.empty() ? "." : folder, error);
  if (error) return false;
  return std::mismatch(top.begin(), top.end(), real.begin(), real.end()).first == top.end();
}

void requireBeside(const fs::path& file, const fs::path& namedBy) {
  if (liesBelow(file, namedBy.parent_path())) return;
  throw IoError(namedBy.string() + ": expected only files beside or below it, found " + file.string());
}

}  // namespace umbrick
