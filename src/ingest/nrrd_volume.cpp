// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/nrrd_volume.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <memory>
#include <vector>

#include "ingest/nrrd_header.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/packed_stream.h"
#include "ingest/streams/text_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// Offset behind `lines` lines, from `offset` on.
std::int64_t skipLines(const fs::path& path, std::int64_t offset, std::int64_t lines) {
  const auto bytes = openPlain(path, offset);
  std::vector<std::byte> buffer(lines > 0 ? 1 << 16 : 0);
  std::int64_t left = lines;
  while (left > 0) {
    const std::size_t got = bytes->read(buffer);
    for (std::size_t i = 0; i < got && left > 0; ++i, ++offset) left -= buffer[i] == std::byte('\n');
    if (got < buffer.size()) break;
  }
  if (left > 0)
    throw IoError(path.string() + ": line skip: expected " + std::to_string(lines) + " lines, found " +
                  std::to_string(lines - left));
  return offset;
}

// The voxels of one file as plain bytes.
std::unique_ptr<ByteStream> openPart(const NrrdHeader& header, const fs::path& path, std::int64_t offset,
                                     std::int64_t voxelBytesHere) {
  const std::int64_t size = checkedFileSize(path);
  if (size < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  offset = skipLines(path, offset, header.lineSkip);
  const bool raw = header.encoding == NrrdEncoding::raw;
  if (raw) {
    if (header.byteSkip < 0) offset = std::max(offset, size - voxelBytesHere);
    offset += std::min(std::max<std::int64_t>(header.byteSkip, 0), size);
    if (size - offset != voxelBytesHere)
      throw IoError(path.string() + ": expected " + std::to_string(voxelBytesHere) + " bytes of " +
                    std::string(voxelTypeName(header.type)) + " voxels, found " +
                    std::to_string(std::max<std::int64_t>(size - offset, 0)));
    return openPlain(path, offset);
  }
  Packing packing = Packing::none;
  if (header.encoding == NrrdEncoding::gzip) packing = Packing::gzip;
  if (header.encoding == NrrdEncoding::bzip2) packing = Packing::bzip2;
  if (packing != Packing::none && packingOf(path, offset) != packing) {
    const std::string name(packingName(packing));
    throw IoError(path.string() + ": encoding: expected " + name + "'d data, found no " + name + " magic at byte " +
                  std::to_string(offset));
  }
  auto bytes = openPacked(path, packing, offset);
  if (bytes->skip(header.byteSkip) < header.byteSkip)
    throw IoError(path.string() + ": byte skip: expected " + std::to_string(header.byteSkip) +
                  " bytes to skip, found fewer");
  if (header.encoding == NrrdEncoding::text) return decimalStream(std::move(bytes), header.type, path.string());
  if (header.encoding == NrrdEncoding::hex) return hexStream(std::move(bytes), path.string());
  return bytes;
}

}  // namespace

std::unique_ptr<VoxelSource> openNrrd(const fs::path& path) {
  const std::int64_t headerFileBytes = checkedFileSize(path);
  const auto shared = std::make_shared<const NrrdHeader>(readNrrdHeader(path));
  const NrrdHeader& header = *shared;
  VolumeInfo info;
  info.name = path.string();
  info.dims = header.dims;
  info.type = header.type;
  info.indexToWorld = header.indexToWorld;
  info.metadata = header.metadata;
  addProvenance(info, path, "NRRD");
  info.fileBytes = std::max<std::int64_t>(headerFileBytes, 0);

  // Several files hold equal shares.
  const std::int64_t total = *volumeBytes(info.dims, info.type);
  const auto count = static_cast<std::int64_t>(std::max<std::size_t>(header.dataFiles.size(), 1));
  if (total / voxelBytes(info.type) % count != 0)
    throw IoError(info.name + ": data file: expected files of equal size, found " + std::to_string(count) +
                  " files for " + describeBytes(info));
  std::vector<std::function<std::unique_ptr<ByteStream>()>> parts;
  const auto addPart = [&](const fs::path& file, std::int64_t offset) {
    const auto open = [shared, file, offset, share = total / count] { return openPart(*shared, file, offset, share); };
    open();  // a missing or short file is told before the first voxel is read
    parts.push_back(open);
  };
  if (header.dataFiles.empty()) addPart(path, header.bytes);
  for (const fs::path& file : header.dataFiles) {
    addPart(file, 0);
    info.fileBytes += checkedFileSize(file);
  }
  const bool text = header.encoding == NrrdEncoding::text;
  const std::endian endian = text ? std::endian::native : header.bigEndian ? std::endian::big : std::endian::little;
  return std::make_unique<DenseSource>(std::move(info), VoxelLayout{header.type, endian, 0},
                                       joinStreams(std::move(parts)), "");
}

}  // namespace umbrick
