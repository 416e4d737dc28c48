// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/vdb_codec.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>

namespace umbrick {

std::uint32_t compressionOf(VdbCodec codec) {
  using namespace openvdb::io;
  if (codec == VdbCodec::none) return COMPRESS_NONE | COMPRESS_ACTIVE_MASK;
  const bool blosc = codec == VdbCodec::blosc && Archive::hasBloscCompression();
  return (blosc ? COMPRESS_BLOSC : COMPRESS_ZIP) | COMPRESS_ACTIVE_MASK;
}

}  // namespace umbrick
