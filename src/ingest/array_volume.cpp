// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/array_volume.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/matrix.hpp>

#include "ingest/parts.h"
#include "ingest/streams/byte_stream.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// The numbers of an array in the order x, y, z with components side by side, as files have them.
class ArrayStream : public ByteStream {
 public:
  explicit ArrayStream(const ArrayVolume& array)
      : array_(array),
        number_(voxelBytes(array.type)),
        row_(array.dims.x * array.components * number_),
        slice_(row_ * array.dims.y),
        dense_(array.strides.x == array.components * number_ && array.strides.y == row_ && array.strides.z == slice_ &&
               (array.components == 1 || array.componentStride == number_)) {}

  std::size_t read(std::span<std::byte> out) override {
    const auto wanted = std::min(static_cast<std::int64_t>(out.size()), slice_ * array_.dims.z - at_);
    std::int64_t done = 0;
    while (done < wanted) {
      std::byte* to = out.data() + done;
      if (dense_) {
        std::memcpy(to, array_.data + at_, static_cast<std::size_t>(wanted));
        advance(wanted, done);
      } else if (at_ % slice_ == 0 && wanted - done >= slice_) {
        const std::int64_t slices = (wanted - done) / slice_;
        gatherSlices(at_ / slice_, slices, to);
        advance(slices * slice_, done);
      } else {
        // What does not begin or end with a slice: row by row, and of a row only the part that is wanted.
        rest_.resize(static_cast<std::size_t>(row_));
        const std::int64_t within = at_ % row_, count = std::min(row_ - within, wanted - done);
        gatherRow(at_ / slice_, at_ % slice_ / row_, 0, array_.dims.x, rest_.data());
        std::memcpy(to, rest_.data() + within, static_cast<std::size_t>(count));
        advance(count, done);
      }
    }
    return static_cast<std::size_t>(done);
  }
  std::int64_t skip(std::int64_t count) override {
    const std::int64_t skipped = std::min(count, slice_ * array_.dims.z - at_);
    at_ += skipped;
    return skipped;
  }
  bool skipsFast() override { return true; }

 private:
  void advance(std::int64_t count, std::int64_t& done) {
    at_ += count;
    done += count;
  }

  // Of an array whose fastest axis is z, neighbours along z share what the processor loads: a few columns of voxels at
  // a time are read through all slices.
  void gatherSlices(std::int64_t first, std::int64_t count, std::byte* to) const {
    constexpr std::int64_t kColumns = 64;
    for (std::int64_t y = 0; y < array_.dims.y; ++y)
      for (std::int64_t x = 0; x < array_.dims.x; x += kColumns) {
        const std::int64_t end = std::min(x + kColumns, array_.dims.x);
        for (std::int64_t z = 0; z < count; ++z)
          gatherRow(first + z, y, x, end, to + z * slice_ + y * row_ + x * array_.components * number_);
      }
  }

  void gatherRow(std::int64_t z, std::int64_t y, std::int64_t x, std::int64_t end, std::byte* to) const {
    const std::byte* from = array_.data + z * array_.strides.z + y * array_.strides.y;
    if (number_ == 1) return gather<1>(from, x, end, to);
    if (number_ == 2) return gather<2>(from, x, end, to);
    if (number_ == 4) return gather<4>(from, x, end, to);
    gather<8>(from, x, end, to);
  }

  template <std::size_t kBytes>
  void gather(const std::byte* from, std::int64_t x, std::int64_t end, std::byte* to) const {
    for (; x < end; ++x)
      for (std::int64_t component = 0; component < array_.components; ++component, to += kBytes)
        std::memcpy(to, from + x * array_.strides.x + component * array_.componentStride, kBytes);
  }

  ArrayVolume array_;
  std::int64_t number_, row_, slice_;  // bytes of a number, of a row along x, and of a slice
  bool dense_;
  std::int64_t at_ = 0;          // bytes that were read
  std::vector<std::byte> rest_;  // a row of which a part is wanted
};

void checkPlace(const std::string& name, const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(matrix[column][row]))
        throw InvalidArgument(name + ": affine: expected finite numbers, found " + std::to_string(matrix[column][row]));
    const double last = column < 3 ? 0 : 1;
    if (matrix[column][3] != last)
      throw InvalidArgument(name + ": affine: expected a last row of 0 0 0 1, found " +
                            std::to_string(matrix[column][3]) + " in column " + std::to_string(column));
  }
  if (!(std::abs(glm::determinant(glm::dmat3(matrix))) > 0))
    throw InvalidArgument(name + ": affine: expected a matrix that can be inverted, found one of determinant 0");
}

}  // namespace

std::unique_ptr<VoxelSource> openArray(const ArrayVolume& array, const std::string& name, const PartChoice& parts) {
  VolumeInfo info;
  info.name = name;
  info.dims = array.dims;
  info.type = array.type;
  info.components = array.components;
  constexpr std::int64_t kMostComponents = 65536;
  if (array.components < 1 || array.components > kMostComponents)
    throw InvalidArgument(name + ": components: expected 1 to " + std::to_string(kMostComponents) + ", found " +
                          std::to_string(array.components));
  if (!arrayBytes(info))
    throw InvalidArgument(name + ": expected an array with 1 to 2147483647 voxels along each axis, found " +
                          std::to_string(array.dims.x) + " x " + std::to_string(array.dims.y) + " x " +
                          std::to_string(array.dims.z));
  guessMeaning(info);
  info.notes.clear();  // which are about files that do not say it
  info.fileBytes = *arrayBytes(info);
  info.metadata["source_format"] = "array";
  if (array.indexToWorld) {
    checkPlace(name, *array.indexToWorld);
    info.indexToWorld = *array.indexToWorld;
  }
  const VoxelLayout layout{array.type, array.endian};
  const auto open = [array] { return std::make_unique<ArrayStream>(array); };
  return openParts(std::move(info), PartAxes{}, layout, parts, open);
}

}  // namespace umbrick
