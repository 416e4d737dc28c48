// Where a study keeps what.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "study/study_record.h"

namespace umbrick {

class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path root) : root_(std::move(root)) {}

  std::filesystem::path record() const { return root_ / "study.json"; }
  std::filesystem::path table() const { return root_ / "study.csv"; }
  std::filesystem::path page() const { return root_ / "index.html"; }
  std::filesystem::path scene() const { return root_ / "scene.json"; }
  std::filesystem::path plots() const { return root_ / "plots"; }
  std::filesystem::path reference(const std::string& id) const { return root_ / "references" / (id + ".exr"); }
  std::filesystem::path picture(const std::string& id) const { return root_ / "pictures" / (id + ".png"); }
  /// What the page shows: the picture itself, or a smaller copy of a large one.
  std::filesystem::path thumbnail(const std::string& id) const;
  std::filesystem::path smallPicture(const std::string& id) const {
    return root_ / "pictures" / "small" / (id + ".png");
  }

  /// Takes over what an earlier run measured. Writes nothing.
  /// @throw InvalidArgument  the folder holds another study or anything else; see restoreRecord
  /// @throw IoError
  void restore(StudyRecord& record) const;
  /// Makes the folder and those in it, and writes the record and the scene. @throw IoError
  void create(const StudyRecord& first) const;

 private:
  std::filesystem::path root_;
};

}  // namespace umbrick
