// A file that a page has sent, in a folder of its own that goes away with it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace umbrick::view {

/// Bytes of a file that a page may send. Larger ones are opened by their path.
inline constexpr std::uint64_t kMostUploadBytes = std::uint64_t{64} << 20;

/// Returns whether a name is one of letters, digits, -, _ and . that a volume could have. A scene names its volume,
/// which would not lie beside it.
bool isUploadName(const std::string& name);

class UploadedFile {
 public:
  /// Makes the folder, which nobody else may look into. @throw InvalidArgument  isUploadName() is false  @throw IoError
  explicit UploadedFile(std::string name);
  ~UploadedFile();
  UploadedFile(const UploadedFile&) = delete;
  UploadedFile& operator=(const UploadedFile&) = delete;

  const std::string& name() const { return name_; }
  std::filesystem::path path() const { return folder_ / name_; }

 private:
  std::string name_;
  std::filesystem::path folder_;
};

}  // namespace umbrick::view
