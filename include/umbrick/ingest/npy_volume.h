// NumPy arrays (.npy) as volumes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens an array of three axes, or of two as one slice; axes of length 1 beyond three are dropped. The
/// file may be of format version 1 to 3 and of either byte order, with integers of 8 to 64 bits, bool or floats of 16
/// to 64 bits, and packed by whatever a raw file may be packed by.
///
/// x is the axis that is fastest in the file, so that both orders stream: an array written in C order is indexed
/// [z, y, x], one in Fortran order [x, y, z]. An array states no place: voxels are 1 apart and the first is at 0.
/// A last axis of 1 to 4 behind three others holds the components of a voxel; else the axis before (C order) or behind
/// (Fortran order) those of space is one of frames.
/// Format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
///
/// @param strict  refuses plain voxels behind which the file goes on, which else is noted
/// @throw SeveralParts  several frames or components, and `parts` chooses none
/// @throw IoError       missing, short, packed and long, malformed, or complex, structured, or an object
std::unique_ptr<VoxelSource> openNpy(const std::filesystem::path& path, const PartChoice& parts = {},
                                     bool strict = false);

}  // namespace umbrick
