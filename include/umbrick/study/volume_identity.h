// Tells which volume a study is of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace umbrick {

/// A volume is known by the bytes of its file, or of the files of its folder, so that one which has moved is still the
/// same volume.
struct VolumeIdentity {
  std::string file;         // absolute path
  std::uint64_t bytes = 0;  // length of the file, or of all files
  std::uint32_t crc32 = 0;  // of all these bytes, as zlib and PNG compute it
};
/// Reads everything once. Files of a folder are taken in the order of their names.
/// @param volume  a file, a folder, or a dataset of a file (run.h5:/density)  @throw IoError  it cannot be read
VolumeIdentity identifyVolume(const std::filesystem::path& volume);

}  // namespace umbrick
