// SPDX-License-Identifier: Apache-2.0
#include "ingest/streams/dense_source.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <sstream>

#include "ingest/parts.h"
#include "ingest/streams/packed_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::size_t kPieceVoxels = std::size_t(1) << 20;  // that are decoded at once
constexpr std::int64_t kMostExtra = std::int64_t(1) << 24;  // bytes behind the last voxel that are looked at

}  // namespace

std::optional<std::int64_t> volumeBytes(const glm::i64vec3& dims, VoxelType type) {
  std::int64_t bytes = voxelBytes(type);
  for (int axis = 0; axis < 3; ++axis)
    if (dims[axis] < 1 || dims[axis] > std::numeric_limits<std::int32_t>::max() ||
        __builtin_mul_overflow(bytes, dims[axis], &bytes))
      return std::nullopt;
  return bytes;
}

std::string describeBytes(const VolumeInfo& info) {
  std::string text =
      std::to_string(info.dims.x) + " x " + std::to_string(info.dims.y) + " x " + std::to_string(info.dims.z) + ' ';
  if (info.components > 1) text += "x " + std::to_string(info.components) + " components ";
  if (info.frames > 1) text += "x " + std::to_string(info.frames) + " frames ";
  return text + std::string(voxelTypeName(info.type)) + " = " + std::to_string(arrayBytes(info).value_or(0)) + " bytes";
}

std::unique_ptr<ByteStream> openVoxels(const VolumeInfo& info, const std::filesystem::path& path, std::int64_t offset,
                                       bool strict) {
  const std::int64_t size = checkedFileSize(path);
  const Packing packing = size >= 0 ? packingOf(path) : Packing::none;
  const std::int64_t expected = arrayBytes(info).value_or(0);
  if (packing == Packing::none && size >= 0) {
    if (!strict && size - offset > expected) return firstBytes(openPlain(path, offset), expected);
    if (size - offset != expected)
      throw IoError(path.string() + ": expected " + describeBytes(info) +
                    (offset > 0 ? " after a header of " + std::to_string(offset) : "") + ", found " +
                    std::to_string(std::max<std::int64_t>(size - offset, 0)));
    return openPlain(path, offset);
  }
  if (packing == Packing::gzip) checkDeflateRatio(path, info, size);
  auto bytes = openPacked(path, packing);
  if (const std::int64_t skipped = bytes->skip(offset); skipped < offset)
    throw IoError(path.string() + ": expected a header of " + std::to_string(offset) + " bytes, found " +
                  std::to_string(skipped) + " bytes in all");
  return bytes;
}

void noteExcess(VolumeInfo& info, const std::filesystem::path& path, std::int64_t offset) {
  const std::int64_t size = checkedFileSize(path), excess = size - offset - arrayBytes(info).value_or(0);
  if (size < 0 || excess <= 0 || packingOf(path) != Packing::none) return;
  info.notes.push_back(path.filename().string() + " has " + std::to_string(size - offset) + " bytes of voxels for " +
                       describeBytes(info) + ": the last " + std::to_string(excess) + " are left out");
}

void checkDeflateRatio(const std::filesystem::path& path, const VolumeInfo& info, std::int64_t packedBytes) {
  // Deflate packs no more than 1032 bytes into one (https://zlib.net/zlib_tech.html).
  const std::int64_t most = (packedBytes + 1) * 1032;
  if (*arrayBytes(info) > most)
    throw IoError(path.string() + ": expected " + describeBytes(info) + ", found " + std::to_string(packedBytes) +
                  " packed ones, which cannot hold more than " + std::to_string(most));
}

std::optional<std::string> describeRescale(const VoxelLayout& layout) {
  if (layout.slope == 1 && layout.intercept == 0) return std::nullopt;
  std::ostringstream text;
  text.precision(17);
  text << layout.intercept << " + " << layout.slope << " * stored";
  return text.str();
}

DenseSource::DenseSource(VolumeInfo info, VoxelLayout layout, std::unique_ptr<ByteStream> bytes, std::string hint)
    : layout_(layout), bytes_(std::move(bytes)), hint_(std::move(hint)) {
  info_ = std::move(info);
  if (const auto rescale = describeRescale(layout)) info_.metadata["rescale"] = *rescale;
}

// In pieces, so that no second slab is held, and none at all is touched for voxels that are only promised.
double DenseSource::readSlab(std::int64_t count, std::span<float> out) {
  assert(std::ssize(out) == info_.dims.x * info_.dims.y * count);
  const auto width = static_cast<std::size_t>(voxelBytes(info_.type));
  double error = 0;
  std::size_t got = 0;
  for (std::size_t first = 0; first < out.size() && got == first * width; first += kPieceVoxels) {
    const auto part = out.subspan(first, std::min(kPieceVoxels, out.size() - first));
    piece_.resize(part.size() * width);
    const std::size_t read = bytes_->read(piece_);
    got += read;
    if (read == piece_.size()) error = std::max(error, decodeVoxels(layout_, piece_, part));
  }
  advance(count, static_cast<std::int64_t>(got));
  return error;
}

void DenseSource::skipSlices(std::int64_t count) {
  advance(count, bytes_->skip(info_.dims.x * info_.dims.y * voxelBytes(info_.type) * count));
}

std::optional<VoxelType> DenseSource::storedType() const {
  // Rescaled values are not those that are stored.
  if (layout_.slope != 1 || layout_.intercept != 0 || layout_.type != info_.type) return std::nullopt;
  switch (info_.type) {
    case VoxelType::u8:
    case VoxelType::i8:
    case VoxelType::u16:
    case VoxelType::i16:
    case VoxelType::f32:
      return info_.type;
    default:
      return std::nullopt;
  }
}

void DenseSource::readStored(std::int64_t count, std::span<std::byte> out) {
  advance(count, static_cast<std::int64_t>(bytes_->read(out)));
  normaliseVoxels(layout_, out);
}

// `got` bytes of the next `count` slices are behind us.
void DenseSource::advance(std::int64_t count, std::int64_t got) {
  assert(count >= 0 && slicesRead_ + count <= info_.dims.z);
  const std::int64_t sliceBytes = info_.dims.x * info_.dims.y * voxelBytes(info_.type);
  if (got < sliceBytes * count)
    throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found " +
                  std::to_string(sliceBytes * slicesRead_ + got));
  slicesRead_ += count;
  if (slicesRead_ == info_.dims.z) checkEnd();
}

void DenseSource::checkEnd() {
  // What is unpacked or comes out of a pipe may never end: the message need not say by how much it is too long.
  const std::int64_t extra = bytes_->skip(kMostExtra);
  if (extra > 0)
    throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found " +
                  (extra == kMostExtra ? "at least " : "") +
                  std::to_string(*volumeBytes(info_.dims, info_.type) + extra) + hint_);
}

}  // namespace umbrick
