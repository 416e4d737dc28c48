// SPDX-License-Identifier: Apache-2.0
#include "core/temporary_name.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <set>

#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr int kSlots = 16;

// A program that ends by a signal can find what it has to remove nowhere but here. What changes names holds the mutex,
// so that there is no name that the list does not have.
std::recursive_mutex namesMutex;
std::set<fs::path>& names() {
  static std::set<fs::path> all;
  return all;
}

[[noreturn]] void fail(const fs::path& target) {
  throw IoError(target.string() + ": cannot write: " + std::strerror(errno));
}

// FNV-1a, which is the same in each program that writes the target.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

fs::path slotOf(const fs::path& target, int slot) {
  char name[48];
  std::snprintf(name, sizeof name, ".umbrick-%016llx-%x",
                static_cast<unsigned long long>(hashOf(target.filename().string())), static_cast<unsigned>(slot));
  // The extension stays, since some readers choose the format by it.
  constexpr std::size_t kMostExtension = 16;
  const std::string extension = target.extension().string();
  return target.parent_path() / (name + (extension.size() <= kMostExtension ? extension : std::string()));
}

bool isSame(const Descriptor& file, const fs::path& path) {
  struct stat opened {
  }, named{};
  return fstat(file.number(), &opened) == 0 && lstat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

// Removes a file that nobody has locked.
void removeUnlocked(const fs::path& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!file || flock(file.number(), LOCK_EX | LOCK_NB) != 0) return;
  // It may have taken its own name, or gone, since it was opened.
  if (isSame(file, path)) ::unlink(path.c_str());
}

// Calls take(path), which tells whether it got that name, for the names of a target. @return the name that it got
template <class Take>
fs::path firstFree(const fs::path& target, const Take& take) {
  for (int slot = 0; slot < kSlots; ++slot) {
    const fs::path path = slotOf(target, slot);
    if (take(path)) return path;
    if (errno != EEXIST) return {};
  }
  errno = EEXIST;
  return {};
}

bool linkAt(const fs::path& from, const fs::path& to) {
  return linkat(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace

TemporaryName TemporaryName::make(const fs::path& target, unsigned mode, Descriptor& file) {
  const std::lock_guard lock(namesMutex);
  const fs::path path = firstFree(target, [&](const fs::path& name) {
    Descriptor made(open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_NOFOLLOW | O_CLOEXEC, mode));
    if (!made) return false;
    // Another program may have found it before it was locked, and taken it for abandoned. Then the next name is tried.
    const bool mine = flock(made.number(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (!mine || !isSame(made, name)) {
      errno = EEXIST;
      return false;
    }
    file = std::move(made);
    return true;
  });
  if (path.empty()) fail(target);
  names().insert(path);
  return TemporaryName(path);
}

TemporaryName TemporaryName::link(const fs::path& from, const fs::path& target) {
  const std::lock_guard lock(namesMutex);
  fs::path path = firstFree(target, [&](const fs::path& name) { return linkAt(from, name); });
  if (path.empty()) {
    if (errno == EPERM || errno == EOPNOTSUPP || errno == EMLINK) return {};
    fail(target);
  }
  names().insert(path);
  return TemporaryName(std::move(path));
}

void TemporaryName::renameTo(const fs::path& target) {
  const std::lock_guard lock(namesMutex);
  if (::rename(path_.c_str(), target.c_str()) != 0) fail(target);
  names().erase(std::exchange(path_, {}));
}

void TemporaryName::keep() {
  const std::lock_guard lock(namesMutex);
  names().erase(std::exchange(path_, {}));
}

void TemporaryName::remove() {
  if (path_.empty()) return;
  const std::lock_guard lock(namesMutex);
  ::unlink(path_.c_str());
  names().erase(std::exchange(path_, {}));
}

void removeAbandoned(const fs::path& target, const std::function<bool(const std::string& name)>& spared) {
  for (int slot = 0; slot < kSlots; ++slot) {
    const fs::path path = slotOf(target, slot);
    if (!spared || !spared(path.filename().string())) removeUnlocked(path);
  }
}

void lockAsOwn(const Descriptor& file) { flock(file.number(), LOCK_EX | LOCK_NB); }

std::unique_lock<std::recursive_mutex> holdNames() { return std::unique_lock(namesMutex); }

bool linkNew(const fs::path& from, const fs::path& target) {
  const std::lock_guard lock(namesMutex);
  if (linkAt(from, target)) return true;
  if (errno != EEXIST) fail(target);
  return false;
}

void abandonPendingFiles() {
  namesMutex.lock();  // for good: no other thread makes a name any more
  for (const fs::path& name : names()) ::unlink(name.c_str());
}

}  // namespace umbrick
