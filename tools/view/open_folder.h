// The folder from which pages open files: what is in it, and nothing else.
//
// A path of a page is names separated by slashes. It is walked name by name from the folder, which is held open, and no
// link is followed on the way: so neither "..", an absolute path nor a link leads out of it, whenever it was made.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/descriptor.h"

namespace umbrick::view {

enum class EntryKind { folder, volume, scene };

struct FolderEntry {
  std::string name;
  EntryKind kind = EntryKind::volume;
  std::uint64_t bytes = 0;  // of a file
};

struct FolderListing {
  std::string path;                  // of a page, empty for the folder itself
  std::vector<FolderEntry> entries;  // folders first, then by name
  std::size_t dicomFiles = 0;        // of the folder, which may be opened as one volume
  std::size_t left = 0;              // entries beyond kMostEntries
  std::size_t links = 0;             // that are not followed
};

/// Entries of a listing at most, so that a message stays small.
inline constexpr std::size_t kMostEntries = 2000;

/// A file or folder that was found.
struct FoundFile {
  std::filesystem::path path;
  bool folder = false;
  dev_t device = 0;
  ino_t number = 0;  // of the file on its device
};

class OpenFolder {
 public:
  /// @throw IoError  it cannot be opened
  explicit OpenFolder(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  /// Lists folders, volumes by the endings of their names, and scenes (.json). What is hidden is left out.
  /// @throw InvalidArgument  `path` is none of a page  @throw IoError  there is no such folder
  FolderListing list(const std::string& path) const;
  /// Finds a file, or a folder. @throw as list
  FoundFile find(const std::string& path) const;
  /// Says whether a file that was opened by its path since it was found is the one that was found.
  /// @throw IoError  it is gone, or another one is in its place
  void requireSame(const std::string& path, const FoundFile& found) const;

 private:
  Descriptor walk(const std::string& path) const;

  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Returns what a file is by the ending of its name; nothing for what a page cannot open.
std::optional<EntryKind> kindOfName(const std::string& name);

}  // namespace umbrick::view
