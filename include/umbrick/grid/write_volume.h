// Grids to files of other formats than .vdb: NanoVDB, and dense MetaImage and NRRD.
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Writes grids to a new .nvdb file of NanoVDB 10, uncompressed 32-bit floats, whole or not at all.
/// @throw IoError          not writable, disk full
/// @throw InvalidArgument  a grid that NanoVDB cannot hold
void writeNanoVdb(const std::filesystem::path& path, const std::vector<openvdb::FloatGrid::ConstPtr>& grids);

struct DenseOptions {
  /// Stored if it is one of u8, i8, u16, i16, u32 and i32 and holds every value of the grid exactly; else f32.
  std::optional<VoxelType> type = {};
  std::int64_t maxBytes = std::int64_t(1) << 34;  // of voxels that are written: 16 GiB
};

/// What was written.
struct DenseBox {
  glm::i64vec3 first{0}, dims{0};  // of the grid's voxels
  VoxelType type = VoxelType::f32;
};

/// Writes the box of the active voxels with what is in it, whole or not at all, as a .nrrd, or as a .mhd beside a .raw
/// of the same stem. The place of the voxels is that of the grid, rotation and shear included.
/// @throw IoError          not writable, disk full
/// @throw InvalidArgument  no active voxel, a box beyond maxBytes, a transform that is not affine, another extension
DenseBox writeDense(const std::filesystem::path& path, const openvdb::FloatGrid& grid,
                    const DenseOptions& options = {});

}  // namespace umbrick
