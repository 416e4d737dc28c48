// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/nrrd_volume.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <vector>

#include "core/input_file.h"
#include "ingest/data_files.h"
#include "ingest/length_unit.h"
#include "ingest/nrrd_header.h"
#include "ingest/provenance.h"
#include "ingest/slicer_segments.h"
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

// The voxels of one file, a share of all, as plain bytes.
std::unique_ptr<ByteStream> openNrrdShare(const NrrdHeader& header, const fs::path& path, std::int64_t offset,
                                          std::int64_t voxelBytesHere, std::vector<std::string>* longer) {
  dataFileSize(path);
  offset = skipLines(path, offset, header.lineSkip);
  if (header.encoding == NrrdEncoding::raw)
    return openPlainShare(path, offset, header.byteSkip, voxelBytesHere, header.type, longer);
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

std::unique_ptr<VoxelSource> openNrrd(const fs::path& path, bool strict, const PartChoice& parts, bool besideOnly) {
  const std::int64_t headerFileBytes = ordinaryFileSize(path);
  const auto header = std::make_shared<const NrrdHeader>(readNrrdHeader(path));
  if (besideOnly) requireDataBeside(header->dataFiles, path);
  VolumeInfo info;
  info.name = path.string();
  info.dims = header->dims;
  info.type = header->type;
  info.indexToWorld = header->indexToWorld;
  info.components = header->components;
  info.frames = header->frames;
  info.meaning = header->meaning;
  info.vectorToWorld = header->measurementFrame;
  info.notes = header->notes;
  info.metadata = header->metadata;
  stateTime(info, header->times, parts.frame);
  if (header->millimetres) useLengthUnit(info, *header->millimetres);
  info.labels = slicerSegments(info.metadata);
  if (info.labels.empty()) guessMeaning(info);
  addProvenance(info, path, "NRRD");
  info.fileBytes = std::max<std::int64_t>(headerFileBytes, 0);

  const auto open = openDataOften(
      info, "data file", path, header->bytes, header->dataFiles, strict,
      [header](const fs::path& file, std::int64_t offset, std::int64_t share, std::vector<std::string>* longer) {
        return openNrrdShare(*header, file, offset, share, longer);
      });
  const bool text = header->encoding == NrrdEncoding::text;
  const std::endian endian = text ? std::endian::native : header->bigEndian ? std::endian::big : std::endian::little;
  const VoxelLayout layout{header->type, endian, 0};
  return openParts(std::move(info), header->parts, layout, parts, open);
}

}  // namespace umbrick
