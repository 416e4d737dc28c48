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
  const std::int64_t sliceVoxels = info_.dims.x * info_.dims.y;
  assert(count >= 0 && slicesRead_ + count <= info_.dims.z && std::ssize(out) == sliceVoxels * count);
  const std::int64_t sliceBytes = sliceVoxels * voxelBytes(info_.type);
  slab_.resize(static_cast<std::size_t>(sliceBytes * count));
  const std::size_t got = bytes_->read(slab_);
  if (got < slab_.size())
    throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found " +
                  std::to_string(sliceBytes * slicesRead_ + static_cast<std::int64_t>(got)));
  slicesRead_ += count;
  if (slicesRead_ == info_.dims.z) checkEnd();
  return decodeVoxels(layout_, slab_, out);
}

void DenseSource::checkEnd() {
  const std::int64_t extra = bytes_->skip(std::numeric_limits<std::int64_t>::max());
  if (extra > 0)
    throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found " +
                  std::to_string(*volumeBytes(info_.dims, info_.type) + extra) + hint_);
}

}  // namespace umbrick
