// How .vdb files are packed, as OpenVDB says it.
#pragma once
#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>

#include <cstdint>

#include "umbrick/grid/build_grid.h"

namespace umbrick {

/// Inactive values are left out; Blosc becomes zip where OpenVDB was built without it.
inline std::uint32_t compressionOf(VdbCodec codec) {
  using namespace openvdb::io;
  if (codec == VdbCodec::none) return COMPRESS_NONE | COMPRESS_ACTIVE_MASK;
  const bool blosc = codec == VdbCodec::blosc && Archive::hasBloscCompression();
  return (blosc ? COMPRESS_BLOSC : COMPRESS_ZIP) | COMPRESS_ACTIVE_MASK;
}

}  // namespace umbrick
