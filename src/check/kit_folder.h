// A folder that appears whole or not at all.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

namespace umbrick {

/// Is written beside the folder that it becomes, under another name, and goes where it does not become it.
class StagedFolder {
 public:
  /// @param target  an empty folder, or none yet, in a folder that there is
  /// @throw InvalidArgument  `target` holds something, or is no folder  @throw IoError  not writable
  explicit StagedFolder(const std::filesystem::path& target);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staged_; }
  /// Gives the folder its name. @throw IoError
  void commit();

 private:
  std::filesystem::path target_, staged_;
};

/// Makes a folder in one that there is. @throw IoError
void makeFolder(const std::filesystem::path& folder);

}  // namespace umbrick
