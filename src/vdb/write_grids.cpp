// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/Archive.h>

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
    Writer writer;
    writer.setCompression(compressionOf(codec));
    writer.write(pending.stream(), grids, /*seekable=*/true, metadata);
    pending.stream().flush();
  } catch (const openvdb::Exception& error) {
    throw IoError(path.string() + ": cannot write: " + error.what());
  }
  if (check) check(pending.path());
  pending.commit();
}

}  // namespace umbrick
