// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/volume_identity.h"

#include <zlib.h>

#include <fstream>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {

VolumeIdentity identifyVolume(const std::filesystem::path& file) {
  VolumeIdentity identity;
  std::error_code ignored;
  const std::filesystem::path absolute = std::filesystem::weakly_canonical(file, ignored);
  identity.file = (ignored ? file : absolute).string();
  std::ifstream in(file, std::ios::binary);
  if (!in) throw IoError(file.string() + ": cannot read");
  std::vector<char> block(std::size_t{1} << 20);
  uLong crc = ::crc32(0, nullptr, 0);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(block.data()), static_cast<uInt>(in.gcount()));
    identity.bytes += static_cast<std::uint64_t>(in.gcount());
  }
  identity.crc32 = static_cast<std::uint32_t>(crc);
  return identity;
}

}  // namespace umbrick
