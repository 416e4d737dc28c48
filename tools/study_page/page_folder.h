// Knows where the page of a study, its plots and its pictures lie in the folder of the study.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <utility>

namespace umbrick::tools {

class PageFolder {
 public:
  explicit PageFolder(std::filesystem::path root) : root_(std::move(root)) {}

  std::filesystem::path page() const { return root_ / "index.html"; }
  std::filesystem::path plots() const { return root_ / "plots"; }
  std::filesystem::path picture(const std::string& id) const { return root_ / "pictures" / (id + ".png"); }
  std::filesystem::path smallPicture(const std::string& id) const {
    return root_ / "pictures" / "small" / (id + ".png");
  }
  /// Returns the file that the page shows: the picture itself, or a smaller copy of a large one.
  std::filesystem::path thumbnail(const std::string& id) const;

  /// Makes the folders of plots and pictures if they are missing. @throw IoError
  void create() const;

 private:
  std::filesystem::path root_;
};

}  // namespace umbrick::tools
