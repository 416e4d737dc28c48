// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/Archive.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/grid/vdb_codec.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {
namespace {

// openvdb::io::File does not notice a full disk, so this class writes through a stream that does.
class Writer : public openvdb::io::Archive {
 public:
  using Archive::write;
};

}  // namespace

void writeGrids(const std::filesystem::path& path, const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                const openvdb::MetaMap& metadata, VdbCodec codec, const WrittenCheck& check) {
  writeAnyGrids(path, openvdb::GridCPtrVec(grids.begin(), grids.end()), metadata, codec, check);
}

void writeAnyGrids(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                   const openvdb::MetaMap& metadata, VdbCodec codec, const WrittenCheck& check) {
  openvdb::initialize();
  PendingFile pending(path);
  try {
    std::ofstream out;
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out.open(pending.path(), std::ios::binary | std::ios::trunc);
    Writer writer;
    writer.setCompression(compressionOf(codec));
    writer.write(out, grids, /*seekable=*/true, metadata);
    out.close();
  } catch (const std::ios_base::failure&) {
    throw IoError(path.string() + ": cannot write: " + std::strerror(errno));
  } catch (const openvdb::Exception& error) {
    throw IoError(path.string() + ": cannot write: " + error.what());
  }
  if (check) check(pending.path());
  pending.commit();
}

}  // namespace umbrick
