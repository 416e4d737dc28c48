// SPDX-License-Identifier: Apache-2.0
#include "study/study_folder.h"

#include <system_error>

#include "core/text_file.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

void createFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder.string() + ": cannot make the folder: " + error.message());
}

}  // namespace

void StudyFolder::restore(StudyRecord& record) const {
  std::error_code error;
  if (!fs::exists(root_, error)) return;
  if (!fs::is_directory(root_, error)) throw InvalidArgument(root_.string() + ": expected a folder, found a file");
  const bool empty = fs::is_empty(root_, error);
  if (error) throw IoError(root_.string() + ": cannot read: " + error.message());
  if (empty) return;
  if (!fs::exists(this->record(), error))
    throw InvalidArgument(root_.string() +
                          ": holds files but no study.json, so it is no study; give an empty or new folder");
  restoreRecord(record, readTextFile(this->record()), this->record().string());
}

void StudyFolder::create(const StudyRecord& first) const {
  createFolder(root_);
  // The record comes first: it says that what follows is a study.
  writeTextFile(record(), printRecord(first));
  createFolder(root_ / "references");
  writeTextFile(scene(), printScene(first.scene) + "\n");
}

}  // namespace umbrick
