// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/volume_identity.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "core/input_file.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"

namespace umbrick {

namespace {
namespace fs = std::filesystem;

// Returns the files that hold a volume: those of a folder in the order of their names; the file before the colon where
// a name goes on with a dataset, as in run.h5:/density.
std::vector<fs::path> filesOf(const fs::path& volume) {
  std::error_code ignored;
  if (fs::is_directory(volume, ignored)) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(volume))
      if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }
  const std::string name = volume.string();
  const std::size_t colon = name.rfind(':');
  if (!fs::exists(volume, ignored) && colon != std::string::npos) return {name.substr(0, colon)};
  return {volume};
}

}  // namespace

VolumeIdentity identifyVolume(const fs::path& volume) {
  VolumeIdentity identity;
  std::error_code ignored;
  const fs::path absolute = fs::weakly_canonical(volume, ignored);
  identity.file = asUtf8((ignored ? volume : absolute).string());  // for records and pages
  std::vector<char> block(std::size_t{1} << 20);
  uLong crc = ::crc32(0, nullptr, 0);
  for (const fs::path& file : filesOf(volume)) {
    ordinaryFileSize(file);
    std::ifstream in(file, std::ios::binary);
    if (!in) throw IoError(file.string() + ": cannot read");
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
      crc = ::crc32(crc, reinterpret_cast<const Bytef*>(block.data()), static_cast<uInt>(in.gcount()));
      identity.bytes += static_cast<std::uint64_t>(in.gcount());
    }
  }
  identity.crc32 = static_cast<std::uint32_t>(crc);
  return identity;
}

}  // namespace umbrick
