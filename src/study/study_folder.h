// Knows where a study keeps its files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "umbrick/study/study_record.h"

namespace umbrick {

class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path root) : root_(std::move(root)) {}

  std::filesystem::path record() const { return root_ / "study.json"; }
  std::filesystem::path table() const { return root_ / "study.csv"; }
  std::filesystem::path scene() const { return root_ / "scene.json"; }
  std::filesystem::path reference(const std::string& id) const { return root_ / "references" / (id + ".exr"); }

  /// Takes over what an earlier run measured, and writes nothing.
  /// @throw InvalidArgument  the folder holds another study or anything else; see restoreRecord
  /// @throw IoError
  void restore(StudyRecord& record) const;
  /// Makes the folder and the folders in it, and writes the record and the scene. @throw IoError
  void create(const StudyRecord& first) const;

 private:
  std::filesystem::path root_;
};

}  // namespace umbrick
