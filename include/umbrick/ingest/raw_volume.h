// Headerless raw volumes: the caller says what the bytes mean.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <filesystem>
#include <memory>
#include <optional>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct RawOptions {
  glm::i64vec3 dims{0};  // voxels along x (fastest), y, z
  VoxelType type = VoxelType::u8;
  std::endian endian = std::endian::little;
  std::int64_t headerBytes = 0;  // these are skipped at the start of the unpacked file
  // The bits of an integer that hold its value. Those above are flags and masked off; signed types are sign-extended.
  std::optional<int> bitsStored = {};
  glm::dvec3 spacing{1};        // world units between voxel centres
  glm::dvec3 origin{0};         // world position of the centre of voxel (0, 0, 0)
  std::int64_t components = 1;  // numbers of a voxel, side by side
};

/// Opens a raw file, plain or packed by gzip, xz, zstd or bzip2. A file of just the size that the options ask for is
/// plain; of others the first bytes tell how they are packed.
/// The size of a plain file is checked at once, that of a packed one as it is read.
/// @param strict  refuses a plain file that is longer than the options say, which else is noted with the doubt that
///                they are wrong
/// @throw InvalidArgument  dims outside [1, 2^31), spacing not positive and finite, origin not finite, headerBytes < 0,
///                         bitsStored outside [1, width of the type] or for floats, components outside [1, 65536]
/// @throw SeveralParts     several components, and `parts` chooses none
/// @throw IoError          missing, a directory, short, or long and packed
std::unique_ptr<VoxelSource> openRaw(const std::filesystem::path& path, const RawOptions& options,
                                     const PartChoice& parts = {}, bool strict = false);

}  // namespace umbrick
