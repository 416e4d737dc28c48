// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/metaimage_volume.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/input_file.h"
#include "ingest/data_files.h"
#include "ingest/metaimage_header.h"
#include "ingest/parts.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/packed_stream.h"
#include "ingest/streams/text_stream.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// The voxels of one file, a share of all, as plain bytes.
std::unique_ptr<ByteStream> openMetaShare(const MetaHeader& header, const fs::path& path, std::int64_t offset,
                                          std::int64_t bytes, std::vector<std::string>* longer) {
  const std::int64_t size = dataFileSize(path);
  if (!header.ascii && !header.compressed)
    return openPlainShare(path, offset, header.skip, bytes, header.layout.type, longer);
  offset += std::min(header.skip, size);
  if (header.ascii) return decimalStream(openPlain(path, offset), header.layout.type, path.string());
  if (header.files.size() <= 1) checkDeflateRatio(path, header.info, size);
  return openPacked(path, Packing::zlib, offset);
}

}  // namespace

std::unique_ptr<VoxelSource> openMetaImage(const fs::path& path, bool strict, const PartChoice& parts,
                                           bool besideOnly) {
  const std::int64_t ownBytes = ordinaryFileSize(path);
  const auto header = std::make_shared<const MetaHeader>(readMetaHeader(path));
  if (besideOnly) requireDataBeside(header->files, path);
  VolumeInfo info = header->info;
  info.fileBytes = std::max<std::int64_t>(ownBytes, 0);
  addProvenance(info, path, "MetaImage");
  const auto open = openDataOften(
      info, "ElementDataFile", path, header->headerBytes, header->files, strict,
      [header](const fs::path& file, std::int64_t offset, std::int64_t share, std::vector<std::string>* longer) {
        return openMetaShare(*header, file, offset, share, longer);
      });
  return openParts(std::move(info), PartAxes{}, header->layout, parts, open);
}

}  // namespace umbrick
