// Which volume a study is of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace umbrick {

/// The volume's file, by what it holds.
struct VolumeIdentity {
  std::string file;
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;
};
/// @throw IoError
VolumeIdentity identify(const std::filesystem::path& file);

}  // namespace umbrick
