// Where voxels come from: a stream of slabs with spacing and orientation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace umbrick {

enum class VoxelType { u8, i8, u16, i16, u32, i32, i64, u64, f16, f32, f64 };

/// "u8" ... "f64"
std::string_view voxelTypeName(VoxelType type);
/// The type of that name, or nothing.
std::optional<VoxelType> voxelTypeFromName(std::string_view name);
/// Bytes of one voxel.
int voxelBytes(VoxelType type);
/// Not an integer.
bool isFloat(VoxelType type);

struct VolumeInfo {
  std::string name;                // what messages call the source, usually its file name
  glm::i64vec3 dims{0};            // voxels along x (fastest), y, z
  glm::dmat4 indexToWorld{1};      // voxel centres at integers; mm where the file states its unit of length
  VoxelType type = VoxelType::u8;  // as stored
  /// source_format and source_file; where the file states them: space (which way the axes of the world point: "LPS" is
  /// towards left, posterior and superior of the patient, "RAS" right, anterior, superior; never converted),
  /// length_unit, modality, rescale (slope and intercept, already applied); and what else is format's own.
  std::map<std::string, std::string> metadata;
  std::int64_t fileBytes = 0;  // of the files that hold it, packed as they are
};

/// Slabs of a dense volume, read in order of z.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;
  const VolumeInfo& info() const { return info_; }
  /// The next `count` slices, x fastest, as 32-bit float: out.size() == dims.x * dims.y * count.
  /// With the last slice the source also checks that nothing is left over.
  /// @return the largest error of the conversion to float in this slab (0 but for integers beyond 24 bits, f64 and
  ///         rescaled values)
  /// @throw IoError  the file ends early or late (expected and found bytes) or cannot be decoded
  virtual double readSlab(std::int64_t count, std::span<float> out) = 0;
  /// Moves past the next `count` slices, as if they had been read. @throw IoError
  virtual void skipSlices(std::int64_t count);
  /// Whether that takes no longer the more is skipped: then a part of the volume can be looked at quickly.
  virtual bool skipsFast() const { return false; }
  /// The type of what readStored gives, one of u8, i8, u16, i16 and f32; nothing where there is only readSlab.
  virtual std::optional<VoxelType> storedType() const { return std::nullopt; }
  /// As readSlab, but the values as they are stored, in the byte order of this machine and without flag bits. They are
  /// what readSlab gives, without an error: out.size() == dims.x * dims.y * count * voxelBytes(*storedType()).
  virtual void readStored(std::int64_t count, std::span<std::byte> out);

 protected:
  VolumeInfo info_;
};

}  // namespace umbrick
