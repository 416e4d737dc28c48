// A file that appears whole or not at all: written beside its name, then renamed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace umbrick {

/// Reserves a temporary name in the folder of `target`. Write to path(), then call commit(). Without a commit the
/// destructor removes what was written, and a file that stood at `target` is untouched.
class PendingFile {
 public:
  /// @throw IoError  the folder does not exist or is not writable, or `target` is a folder
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& path() const { return temporary_; }
  /// Writes the whole file. @throw IoError
  void write(std::string_view text);
  /// Returns when what was written is on the disk. @throw IoError
  void flush();
  /// Flushes the written file to the disk and renames it to the target.
  /// @throw IoError  nothing was written, or the rename failed
  void commit();
  /// Makes the destructor leave the temporary file where it is.
  void keep() { kept_ = true; }

 private:
  std::filesystem::path target_, temporary_;
  bool kept_ = false;
};

/// A check of a file that is written but has not taken its name. When it throws, what stood there is untouched.
using WrittenCheck = std::function<void(const std::filesystem::path& written)>;

/// Writes a whole text file through a PendingFile. @throw IoError
void writeTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace umbrick
