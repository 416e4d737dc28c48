// SPDX-License-Identifier: Apache-2.0
#include "check/kit_folder.h"

#include <unistd.h>

#include <string>
#include <system_error>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;

StagedFolder::StagedFolder(const fs::path& target) : target_(target.lexically_normal()) {
  if (!target_.has_filename()) target_ = target_.parent_path();  // "kit/" is "kit"
  std::error_code error;
  if (fs::exists(target_, error)) {
    if (!fs::is_directory(target_, error)) throw InvalidArgument(target.string() + ": expected a folder, found a file");
    const bool empty = fs::is_empty(target_, error);
    if (error) throw IoError(target.string() + ": cannot read: " + error.message());
    if (!empty) throw InvalidArgument(target.string() + ": holds files; a kit goes to an empty folder or a new one");
    target_ = fs::canonical(target_);  // a link leads to the folder that takes the name
  }
  const std::string name = target_.string() + ".partial-" + std::to_string(getpid());
  for (int attempt = 0; staged_.empty(); ++attempt) {
    const fs::path next = attempt == 0 ? name : name + "-" + std::to_string(attempt);
    if (fs::create_directory(next, error)) staged_ = next;
    if (error) throw IoError(target.string() + ": cannot make the folder: " + error.message());
  }
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staged_.empty()) fs::remove_all(staged_, ignored);
}

void StagedFolder::commit() {
  std::error_code error;
  fs::rename(staged_, target_, error);
  if (error) throw IoError(target_.string() + ": cannot take the place of the folder: " + error.message());
  staged_.clear();
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) throw IoError(folder.string() + ": cannot make the folder: " + error.message());
}

}  // namespace umbrick
