// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLinks = 40;  // as many as Linux follows

[[noreturn]] void refuse(const fs::path& target, const std::string& why) {
  throw IoError(target.string() + ": cannot write: " + why);
}

// Returns the number N of a name /proc/PID/fd/N of this process, or -1. Such a name is a link, but not to a path.
int descriptorOf(const fs::path& name) {
  const std::string number = name.filename().string();
  if (number.empty() || !std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; }))
    return -1;
  std::error_code error;
  const std::string folder = fs::canonical(name.parent_path(), error).string();
  const std::string own = fs::canonical("/proc/self", error).string();
  // A thread has a folder of its own: /proc/PID/task/TID/fd.
  const bool inThread = folder.starts_with(own + "/task/") && folder.ends_with("/fd");
  if (error || !(folder == own + "/fd" || inThread)) return -1;
  int descriptor = -1;
  std::from_chars(number.data(), number.data() + number.size(), descriptor);
  return descriptor;
}

// Follows the links of the last name; those of folders are left to the system.
// @param descriptor  becomes that of a link to an open descriptor, at which the way ends
fs::path followed(const fs::path& target, int& descriptor) {
  fs::path at = target;
  for (int i = 0; i < kMostLinks; ++i) {
    if ((descriptor = descriptorOf(at)) >= 0) return at;
    std::error_code error;
    const fs::path link = fs::read_symlink(at, error);
    if (error) return at;
    at = at.parent_path() / link;
  }
  refuse(target, std::strerror(ELOOP));
}

}  // namespace

Output outputAt(const fs::path& target) {
  Output output{.given = target, .path = target};
  if (target.empty() || target.filename().empty()) refuse(target, "is a directory");
  output.path = followed(target, output.descriptor);
  struct stat found {};
  if (output.descriptor >= 0) {
    if (fstat(output.descriptor, &found) != 0) refuse(target, std::strerror(errno));
    output.kind = OutputKind::stream;
    return output;
  }
  if (stat(output.path.c_str(), &found) != 0) return output;  // what else is wrong shows when it is written
  if (S_ISDIR(found.st_mode)) refuse(target, "is a directory");
  if (S_ISBLK(found.st_mode)) refuse(target, "is a disk");
  if (!S_ISREG(found.st_mode)) {
    output.kind = OutputKind::stream;
    return output;
  }
  output.standing = StandingFile{found.st_mode & 07777u, found.st_uid, found.st_gid, found.st_nlink};
  return output;
}

std::optional<std::string> whyProtected(const Output& output) {
  if (!output.standing) return std::nullopt;
  const uid_t me = geteuid();
  // Everything is writable for root, who means it no more than others.
  if ((output.standing->mode & 0222u) == 0 || faccessat(AT_FDCWD, output.path.c_str(), W_OK, AT_EACCESS) != 0)
    return "is read-only";
  if (me != 0 && output.standing->user != me) return "belongs to another user";
  return std::nullopt;
}

}  // namespace umbrick
