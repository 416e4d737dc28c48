// A file that appears whole or not at all: written beside its name, then renamed.
#pragma once
#include <filesystem>
#include <string_view>

namespace umbrick {

/// Reserves a temporary name in the folder of `target`. Write to path(), then commit(); without a commit the
/// destructor removes what was written, and a file that stood at `target` is untouched.
class PendingFile {
 public:
  /// @throw IoError  the folder does not exist or is not writable, or `target` is a folder
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& path() const { return temporary_; }
  /// Flushes the written file to the disk and renames it to the target.
  /// @throw IoError  nothing was written, or the rename failed
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// Writes a whole text file through a PendingFile. @throw IoError
void writeTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace umbrick
