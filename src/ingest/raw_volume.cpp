// No library serves headerless files: there is nothing to parse, and the packings are those of streams/packed_stream.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/raw_volume.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <sstream>

#include "ingest/parts.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/packed_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr const char* kHint = "; does it begin with a header (headerBytes), or are the dims or the type wrong?";

template <class Vector>
std::string text(const Vector& v, const char* between) {
  std::ostringstream out;
  out << v.x << between << v.y << between << v.z;
  return out.str();
}

void checkOptions(const std::string& name, const RawOptions& options) {
  if (!volumeBytes(options.dims, options.type))
    throw InvalidArgument(name + ": dims: expected each from 1 to 2147483647 and less than 2^63 bytes in all, found " +
                          text(options.dims, " x "));
  for (int axis = 0; axis < 3; ++axis) {
    if (!(options.spacing[axis] > 0) || !std::isfinite(options.spacing[axis]))
      throw InvalidArgument(name + ": spacing: expected positive finite numbers, found " + text(options.spacing, " "));
    if (!std::isfinite(options.origin[axis]))
      throw InvalidArgument(name + ": origin: expected finite numbers, found " + text(options.origin, " "));
  }
  if (options.headerBytes < 0)
    throw InvalidArgument(name + ": header bytes: expected 0 or more, found " + std::to_string(options.headerBytes));
  constexpr std::int64_t kMostComponents = 65536;
  if (options.components < 1 || options.components > kMostComponents)
    throw InvalidArgument(name + ": components: expected 1 to " + std::to_string(kMostComponents) + ", found " +
                          std::to_string(options.components));
  if (!options.bitsStored) return;
  const std::string type(voxelTypeName(options.type));
  if (isFloat(options.type)) throw InvalidArgument(name + ": bits stored: only integers can have fewer, not " + type);
  if (*options.bitsStored < 1 || *options.bitsStored > 8 * voxelBytes(options.type))
    throw InvalidArgument(name + ": bits stored: expected 1 to " + std::to_string(8 * voxelBytes(options.type)) +
                          " for " + type + ", found " + std::to_string(*options.bitsStored));
}

}  // namespace

std::unique_ptr<VoxelSource> openRaw(const fs::path& path, const RawOptions& options, const PartChoice& parts,
                                     bool strict) {
  VolumeInfo info;
  info.name = path.string();
  checkOptions(info.name, options);
  info.dims = options.dims;
  info.type = options.type;
  info.components = options.components;
  if (!arrayBytes(info)) throw InvalidArgument(info.name + ": dims and components: expected less than 2^63 bytes");
  guessMeaning(info);
  info.indexToWorld = glm::scale(glm::translate(glm::dmat4(1), options.origin), options.spacing);
  const std::int64_t size = checkedFileSize(path);
  info.fileBytes = std::max<std::int64_t>(size, 0);
  addProvenance(info, path, "raw");

  // A plain file of the right size is plain, whatever its first bytes; else the magic bytes of a packing decide.
  const std::int64_t expected = *arrayBytes(info);
  const bool fits = size >= options.headerBytes && size - options.headerBytes == expected;
  const Packing packing = size >= 0 && !fits ? packingOf(path) : Packing::none;
  const bool longer = size >= 0 && packing == Packing::none && size - options.headerBytes > expected;
  if (longer && !strict) {
    noteExcess(info, path, options.headerBytes);
    info.notes.back() += "; does it begin with a header, or are the dims or the type wrong?";
  } else if (size >= 0 && !fits && packing == Packing::none) {
    std::string header;
    if (options.headerBytes > 0) header = " after a header of " + std::to_string(options.headerBytes);
    throw IoError(info.name + ": expected " + describeBytes(info) + header + ", found " +
                  std::to_string(std::max<std::int64_t>(size - options.headerBytes, 0)) + (longer ? kHint : ""));
  }
  if (packing == Packing::gzip) checkDeflateRatio(path, info, size);
  const auto open = [path, packing, longer, expected, headerBytes = options.headerBytes,
                     name = info.name]() -> std::unique_ptr<ByteStream> {
    auto bytes = openPacked(path, packing);
    if (const std::int64_t skipped = bytes->skip(headerBytes); skipped < headerBytes)
      throw IoError(name + ": expected a header of " + std::to_string(headerBytes) + " bytes, found " +
                    std::to_string(skipped) + " bytes in all");
    return longer ? firstBytes(std::move(bytes), expected) : std::move(bytes);
  };
  const VoxelLayout layout{options.type, options.endian, options.bitsStored.value_or(0)};
  return openParts(std::move(info), PartAxes{}, layout, parts, open, kHint);
}

}  // namespace umbrick
