// The folder of a scene, from which it names its files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <utility>

#include "core/input_file.h"
#include "core/json_reader.h"

namespace umbrick {

class SceneFolder {
 public:
  /// @param besideOnly  a scene names no files but those in the folder and below it
  SceneFolder(std::filesystem::path path, bool besideOnly) : path_(std::move(path)), besideOnly_(besideOnly) {}

  bool besideOnly() const { return besideOnly_; }
  /// The file that a value of the scene names. @throw IoError  it lies elsewhere, links and ".." followed
  std::filesystem::path file(const JsonValue& name) const {
    std::filesystem::path file = path_ / name.string();
    if (besideOnly_ && !liesBelow(file, path_)) name.fail("expected a file beside or below the scene, found another");
    return file;
  }

 private:
  std::filesystem::path path_;
  bool besideOnly_;
};

}  // namespace umbrick
