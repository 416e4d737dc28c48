#include "ingest/dense_source.h"

#include <cassert>
#include <limits>

#include "umbrick/core/error.h"

namespace umbrick {

std::optional<std::int64_t> volumeBytes(const glm::i64vec3& dims, VoxelType type) {
  std::int64_t bytes = voxelBytes(type);
  for (int axis = 0; axis < 3; ++axis)
    if (dims[axis] < 1 || dims[axis] > std::numeric_limits<std::int32_t>::max() ||
        __builtin_mul_overflow(bytes, dims[axis], &bytes))
      return std::nullopt;
  return bytes;
}

std::string describeBytes(const VolumeInfo& info) {
  return std::to_string(info.dims.x) + " x " + std::to_string(info.dims.y) + " x " + std::to_string(info.dims.z) + ' ' +
         std::string(voxelTypeName(info.type)) + " = " + std::to_string(volumeBytes(info.dims, info.type).value_or(0)) +
         " bytes";
}

DenseSource::DenseSource(VolumeInfo info, VoxelLayout layout, std::unique_ptr<ByteStream> bytes, std::string hint)
    : layout_(layout), bytes_(std::move(bytes)), hint_(std::move(hint)) {
  info_ = std::move(info);
}

double DenseSource::readSlab(std::int64_t count, std::span<float> out) {
  assert(std::ssize(out) == info_.dims.x * info_.dims.y * count);
  slab_.resize(out.size() * static_cast<std::size_t>(voxelBytes(info_.type)));
  readBytes(count, slab_);
  return decodeVoxels(layout_, slab_, out);
}

void DenseSource::skipSlices(std::int64_t count) {
  advance(count, bytes_->skip(info_.dims.x * info_.dims.y * voxelBytes(info_.type) * count));
}

std::optional<VoxelType> DenseSource::storedType() const {
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
  readBytes(count, out);
  normaliseVoxels(layout_, out);
}

void DenseSource::readBytes(std::int64_t count, std::span<std::byte> out) {
  advance(count, static_cast<std::int64_t>(bytes_->read(out)));
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
  const std::int64_t extra = bytes_->skip(std::numeric_limits<std::int64_t>::max());
  if (extra > 0)
    throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found " +
                  std::to_string(*volumeBytes(info_.dims, info_.type) + extra) + hint_);
}

}  // namespace umbrick
