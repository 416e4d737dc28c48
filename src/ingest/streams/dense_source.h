// A volume as a stream of bytes, read as slabs. Every format whose voxels lie in one dense array ends here.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/streams/byte_stream.h"
#include "ingest/streams/decode.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Bytes of the voxels, or nothing when some dimension is outside [1, 2^31) or the bytes do not fit into 63 bits.
std::optional<std::int64_t> volumeBytes(const glm::i64vec3& dims, VoxelType type);

/// "256 x 256 x 94 u16 = 12320768 bytes"
std::string describeBytes(const VolumeInfo& info);

/// Opens a file that holds all voxels, from byte `offset` of the unpacked file on. The first bytes tell its packing.
/// @param strict  a plain file must end with the last voxel, and else may go on
/// @throw IoError  a plain file of another size, or a packed one too small to hold so much
std::unique_ptr<ByteStream> openVoxels(const VolumeInfo& info, const std::filesystem::path& path, std::int64_t offset,
                                       bool strict);

/// Adds a note with both sizes where a plain file goes on behind its voxels.
void noteExcess(VolumeInfo& info, const std::filesystem::path& path, std::int64_t offset);

/// Refuses gzip or zlib data that are too small to become so many voxels, before anything is allocated for these.
/// @throw IoError
void checkDeflateRatio(const std::filesystem::path& path, const VolumeInfo& info, std::int64_t packedBytes);

/// "-1000 + 2.5 * stored", or nothing when there is nothing to rescale
std::optional<std::string> describeRescale(const VoxelLayout& layout);

class DenseSource : public VoxelSource {
 public:
  /// @param bytes  stands at the first voxel
  /// @param hint   added to the message when bytes are left over
  DenseSource(VolumeInfo info, VoxelLayout layout, std::unique_ptr<ByteStream> bytes, std::string hint);
  double readSlab(std::int64_t count, std::span<float> out) override;
  void skipSlices(std::int64_t count) override;
  bool skipsFast() const override { return bytes_->skipsFast(); }
  std::optional<VoxelType> storedType() const override;
  void readStored(std::int64_t count, std::span<std::byte> out) override;

 private:
  void advance(std::int64_t count, std::int64_t got);
  void checkEnd();

  VoxelLayout layout_;
  std::unique_ptr<ByteStream> bytes_;
  std::string hint_;
  std::vector<std::byte> piece_;
  std::int64_t slicesRead_ = 0;
};

}  // namespace umbrick
