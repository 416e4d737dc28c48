// The text at the head of a MetaImage. Own code, since ITK's MetaImageIO reads a part of a volume only where the
// file is not compressed; a compressed one is held as a whole.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "ingest/streams/decode.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// What the header says, checked: the volume, where its voxels are and how they lie there.
struct MetaHeader {
  VolumeInfo info;
  VoxelLayout layout;
  bool ascii = false, compressed = false;
  std::int64_t skip = 0;                     // of each file; -1: the voxels are the last bytes of it
  std::vector<std::filesystem::path> files;  // empty: the voxels follow the header
  std::int64_t headerBytes = 0;
};

/// @throw IoError  naming the file, the field, what was expected and what was found
MetaHeader readMetaHeader(const std::filesystem::path& path);

}  // namespace umbrick
