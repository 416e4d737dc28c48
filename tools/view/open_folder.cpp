// SPDX-License-Identifier: Apache-2.0
#include "view/open_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick::view {
namespace {

constexpr std::size_t kLongestPath = 1000;  // bytes

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InvalidArgument("open: '" + printable(path.substr(0, 200)) + "' " + why);
}

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw IoError("open: " + (path.empty() ? std::string("the folder of the server") : printable(path)) + ": " + why);
}

std::vector<std::string> namesOf(const std::string& path) {
  std::vector<std::string> names;
  if (path.empty()) return names;
  if (path.size() > kLongestPath) refuse(path, "is too long");
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    const bool control = std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; });
    // Hidden files are keys and settings rather than volumes; "." and ".." are among them.
    if (name.empty() || name.front() == '.' || control) refuse(path, "is no path below the folder of the server");
    names.push_back(name);
    begin = end + 1;
  }
  return names;
}

struct stat statusOf(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail(path, std::strerror(errno));
  return status;
}

bool endsWith(const std::string& name, const std::string& ending) {
  if (name.size() <= ending.size()) return false;
  return std::equal(ending.begin(), ending.end(), name.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

bool isDicom(const std::string& name) { return endsWith(name, ".dcm") || endsWith(name, ".ima"); }

}  // namespace

std::optional<EntryKind> kindOfName(const std::string& name) {
  if (endsWith(name, ".json")) return EntryKind::scene;
  if (endsWith(name, ".vdb") || endsWith(name, ".nvdb")) return EntryKind::volume;
  for (const FormatRow& row : listFormats())
    // Voxels without a header need options that a page has not.
    if (row.name != "raw" && std::any_of(row.extensions.begin(), row.extensions.end(),
                                         [&](const std::string& ending) { return endsWith(name, ending); }))
      return EntryKind::volume;
  return std::nullopt;
}

OpenFolder::OpenFolder(const std::filesystem::path& path) {
  std::error_code failed;
  path_ = std::filesystem::canonical(path, failed);
  if (!failed) descriptor_ = Descriptor(::open(path_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor_) throw IoError(path.string() + ": is no folder that can be opened");
}

Descriptor OpenFolder::walk(const std::string& path) const {
  Descriptor at(::openat(descriptor_.number(), ".", O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!at) fail(path, std::strerror(errno));
  for (const std::string& name : namesOf(path)) {
    at = Descriptor(::openat(at.number(), name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    if (!at) fail(path, std::strerror(errno));
    const mode_t mode = statusOf(at.number(), path).st_mode;
    if (S_ISLNK(mode)) refuse(path, "has a link in it, which is not followed");
    if (!S_ISDIR(mode) && !S_ISREG(mode)) refuse(path, "is neither a file nor a folder");
  }
  return at;
}

FoundFile OpenFolder::find(const std::string& path) const {
  const Descriptor found(walk(path));
  const struct stat status = statusOf(found.number(), path);
  return {path.empty() ? path_ : path_ / path, S_ISDIR(status.st_mode) != 0, status.st_dev, status.st_ino};
}

void OpenFolder::requireSame(const std::string& path, const FoundFile& found) const {
  const FoundFile now = find(path);
  if (now.device != found.device || now.number != found.number)
    fail(path, "another file took its place while it was opened");
}

FolderListing OpenFolder::list(const std::string& path) const {
  const Descriptor found(walk(path));
  // A descriptor of a path cannot be read; "." of it can.
  const int readable = ::openat(found.number(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (readable < 0) fail(path, std::strerror(errno));
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::fdopendir(readable), ::closedir);
  if (!folder) fail(path, std::strerror(errno));
  FolderListing listing;
  listing.path = path;
  while (const dirent* entry = ::readdir(folder.get())) {
    const std::string name = entry->d_name;
    if (name.front() == '.' || asUtf8(name) != name) continue;  // hidden, or a name that JSON cannot hold
    struct stat status {};
    if (::fstatat(found.number(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) continue;  // has just gone
    if (S_ISLNK(status.st_mode)) {
      ++listing.links;
    } else if (S_ISDIR(status.st_mode)) {
      listing.entries.push_back({name, EntryKind::folder, 0});
    } else if (const auto kind = kindOfName(name); kind && S_ISREG(status.st_mode)) {
      listing.dicomFiles += isDicom(name);
      listing.entries.push_back({name, *kind, static_cast<std::uint64_t>(status.st_size)});
    }
  }
  std::sort(listing.entries.begin(), listing.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    const bool first = a.kind == EntryKind::folder, second = b.kind == EntryKind::folder;
    return first != second ? first : a.name < b.name;
  });
  if (listing.entries.size() > kMostEntries) {
    listing.left = listing.entries.size() - kMostEntries;
    listing.entries.resize(kMostEntries);
  }
  return listing;
}

}  // namespace umbrick::view
