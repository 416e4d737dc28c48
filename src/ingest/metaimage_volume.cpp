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
  const auto longer = strict ? nullptr : std::make_shared<std::vector<std::string>>();
  const std::int64_t ownSize = info.fileBytes;
  const auto openAll = [header, longer, path, ownSize](VolumeInfo& of) {
    of.fileBytes = ownSize;
    return openDataFiles(of, "ElementDataFile", path, header->headerBytes, header->files,
                         [header, longer](const fs::path& file, std::int64_t offset, std::int64_t share) {
                           return openMetaShare(*header, file, offset, share, longer.get());
                         });
  };
  auto first = openAll(info);  // looks at all files before the first voxel is read
  if (longer) info.notes.insert(info.notes.end(), longer->begin(), longer->end());
  auto open = openOnceMore(std::move(first), [openAll, of = info]() mutable { return openAll(of); });
  return openParts(std::move(info), PartAxes{}, header->layout, parts, open);
}

}  // namespace umbrick
