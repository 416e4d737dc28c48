// Tells which volume a study is of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace umbrick {

/// A volume is known by the bytes of its file, so that a file which has moved is still the same volume.
struct VolumeIdentity {
  std::string file;         // absolute path
  std::uint64_t bytes = 0;  // length of the file
  std::uint32_t crc32 = 0;  // of all its bytes, as zlib and PNG compute it
};
/// Reads the whole file once. @throw IoError  it cannot be read
VolumeIdentity identifyVolume(const std::filesystem::path& file);

}  // namespace umbrick
