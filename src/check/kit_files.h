// Where the files of a kit lie.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

namespace umbrick {

inline constexpr int kKitFormat = 1;  // of kit.json and case.json
inline constexpr const char* kErrorBarLayer = "errorBar";
inline constexpr const char* kDepthLayer = "Z";

struct KitFiles {
  std::filesystem::path root;

  std::filesystem::path readme() const { return root / "README.md"; }
  std::filesystem::path manifest() const { return root / "kit.json"; }
  std::filesystem::path cases() const { return root / "cases"; }
  std::filesystem::path folder(const std::string& kitCase) const { return cases() / kitCase; }
  std::filesystem::path description(const std::string& kitCase) const { return folder(kitCase) / "case.json"; }
  std::filesystem::path answers() const { return root / "answers"; }
  std::filesystem::path answers(const std::string& kitCase) const { return answers() / kitCase; }
};

}  // namespace umbrick
