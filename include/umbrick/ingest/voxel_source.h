// Where voxels come from: a stream of slabs with spacing and orientation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace umbrick {

enum class VoxelType { u8, i8, u16, i16, u32, i32, i64, u64, f16, f32, f64 };

/// The name of a type, "u8" to "f64".
std::string_view voxelTypeName(VoxelType type);
/// The type of that name, or nothing.
std::optional<VoxelType> voxelTypeFromName(std::string_view name);
/// How many bytes one voxel takes.
int voxelBytes(VoxelType type);
/// True for f16, f32 and f64.
bool isFloat(VoxelType type);

/// What the numbers of one voxel are together.
enum class VoxelMeaning { scalar, vector, colour };

/// A part of a volume of labels that its file names: the voxels of one value.
struct VolumeLabel {
  std::string name;                       // as the file spells it; may be empty
  std::int64_t value = 0;                 // of its voxels; 0 is no label, but is the background
  std::int64_t component = 0;             // which number of a voxel holds it, where labels lie in several layers
  std::optional<glm::dvec3> colour = {};  // sRGB, each from 0 to 1
};

struct VolumeInfo {
  std::string name;                // what messages call the source, usually its file name
  glm::i64vec3 dims{0};            // voxels along x (fastest), y, z
  glm::dmat4 indexToWorld{1};      // voxel centres lie at integers; the world is in metadata["length_unit"]
  VoxelType type = VoxelType::u8;  // of the voxels as they are stored
  /// What the file says beside its voxels. Every source gives source_format and source_file. Where the file states
  /// them, there are length_unit (mm, or um, nm or pm where OpenVDB cannot hold voxels that small in mm), modality,
  /// rescale (a slope and an intercept that are already applied) and space, which says which way the axes of the world
  /// point: "LPS" is towards left, posterior and superior of the patient, "RAS" towards right, anterior and superior.
  /// Spaces are never converted. Of time there are, as far as the file tells: frame, the number of the volume in a file
  /// of several, counted from 0, or its TemporalPositionIdentifier (DICOM); time, when the volume is, and time_step,
  /// from one to the next, both in time_unit, as the file spells it; cycle, the number of the solver's step (legacy
  /// VTK); acquisition_date and acquisition_time (DICOM). Other keys belong to one format.
  std::map<std::string, std::string> metadata;
  /// What a user should know of how the file was read: what was chosen, guessed or left out, a line each, without the
  /// name of the file.
  std::vector<std::string> notes;
  std::int64_t fileBytes = 0;                   // size of all files that hold the volume, packed as they are
  std::int64_t components = 1;                  // numbers of a voxel in the file
  VoxelMeaning meaning = VoxelMeaning::scalar;  // of all components together
  std::int64_t frames = 1;                      // volumes of this size in the file; a source is one of them
  /// What turns a vector as it is stored into one of the world: the measurement frame of NRRD. It is not applied by the
  /// source.
  glm::dmat3 vectorToWorld{1};
  /// Numbers of a voxel that the source gives: 1, or all components side by side, where OpenOptions::parts asked for
  /// all of them.
  std::int64_t valuesPerVoxel = 1;
  std::vector<VolumeLabel> labels;  // that the file names, in its order
};

/// A dense volume that is read as slabs, in order of z.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;
  const VolumeInfo& info() const { return info_; }
  /// The next `count` slices, x fastest, as 32-bit float: out.size() == dims.x * dims.y * count, times valuesPerVoxel.
  /// With the last slice the source also checks that nothing is left over.
  /// @return the largest error that the conversion to float made in this slab; it can only differ from 0 for integers
  ///         beyond 24 bits, f64 and rescaled values
  /// @throw IoError  the file ends early or late (expected and found bytes) or cannot be decoded
  virtual double readSlab(std::int64_t count, std::span<float> out) = 0;
  /// Moves past the next `count` slices, as if they had been read. @throw IoError
  virtual void skipSlices(std::int64_t count);
  /// True when skipping many slices takes no longer than skipping one: then a part of the volume is reached quickly.
  virtual bool skipsFast() const { return false; }
  /// The type of what readStored gives, one of u8, i8, u16, i16 and f32; nothing where there is only readSlab.
  virtual std::optional<VoxelType> storedType() const { return std::nullopt; }
  /// Reads as readSlab does, but gives the values in their stored type, in the byte order of this machine and without
  /// flag bits. They equal those of readSlab exactly.
  /// out.size() == dims.x * dims.y * count * voxelBytes(*storedType()), times valuesPerVoxel
  virtual void readStored(std::int64_t count, std::span<std::byte> out);

 protected:
  VolumeInfo info_;
};

}  // namespace umbrick
