// Grids to files: .vdb, NanoVDB, and dense MetaImage and NRRD.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/pending_file.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/vdb_codec.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Writes grids to a new .vdb file, whole or not at all. Inactive values are left out. What `check`
/// throws is passed on.
/// @throw IoError  the file is not writable, or the disk is full
void writeGrids(const std::filesystem::path& path, const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                const openvdb::MetaMap& metadata = {}, VdbCodec codec = VdbCodec::blosc,
                const WrittenCheck& check = {});
/// Does the same for grids of any type.
void writeAnyGrids(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                   const openvdb::MetaMap& metadata = {}, VdbCodec codec = VdbCodec::blosc,
                   const WrittenCheck& check = {});

/// How NanoVDB stores the values of a leaf: as 32-bit floats, or in so many bits each between the smallest and the
/// largest of the leaf's 512 values. With `adaptive`, each leaf takes the fewest of 1, 2, 4, 8 and 16 bits that
/// keep maxError.
enum class NanoValues { float32, bits4, bits8, bits16, adaptive };

struct NanoOptions {
  NanoValues values = NanoValues::float32;
  float maxError = 0;  // used by `adaptive` only, grid units
};

/// A WrittenCheck that is also told the errors of the grids.
using NanoCheck = std::function<void(const std::filesystem::path& written, const std::vector<QuantiseError>& errors)>;

/// Writes grids to a new .nvdb file of NanoVDB 32.4, unpacked, whole or not at all. Of the metadata the file keeps
/// only the name.
/// @return the error of each grid, as measured; 0 for 32-bit floats
/// @throw IoError          the file is not writable, or the disk is full
/// @throw InvalidArgument  NanoVDB cannot hold a grid, or 16 bits a value do not keep maxError
std::vector<QuantiseError> writeNanoVdb(const std::filesystem::path& path,
                                        const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                                        const NanoOptions& options = {}, const NanoCheck& check = {});

struct DenseOptions {
  /// The values are stored in this type if it is one of u8, i8, u16, i16, u32 and i32 and holds every value of the grid
  /// exactly; else they are stored as f32.
  std::optional<VoxelType> type = {};
  std::int64_t maxBytes = std::int64_t(1) << 34;  // at most so many bytes of voxels are written: 16 GiB
  bool nrrd = false;                              // also where the name does not end in .nrrd, as that of a stream
};

/// The box and the type that were written.
struct DenseBox {
  glm::i64vec3 first{0}, dims{0};  // first voxel in index space of the grid, and number of voxels
  VoxelType type = VoxelType::f32;
  std::string space;  // in which the header states the place, such as "LPS"; empty where nothing is known
};

/// Returns the .raw of a .mhd: beside what it is a link to, if it is one.
/// @throw IoError  a link to another folder, where the data would not be found
std::filesystem::path voxelFileOf(const std::filesystem::path& header);

/// Writes the box of the active voxels with all values in it, whole or not at all, as a .nrrd, or as a .mhd beside a
/// .raw of the same stem (PendingPair). The place of the voxels is that of the grid, rotation and shear included. A
/// .mhd means LPS: a grid that states another space of a patient is turned to it, and in a .nrrd one whose space has no
/// word there.
/// @throw IoError          a file is not writable, or the disk is full
/// @throw InvalidArgument  no active voxel, a box beyond maxBytes, a transform that is not affine, or another extension
DenseBox writeDense(const std::filesystem::path& path, const openvdb::FloatGrid& grid, const DenseOptions& options = {},
                    const WrittenCheck& check = {});

}  // namespace umbrick
