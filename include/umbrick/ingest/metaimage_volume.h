// MetaImage volumes: .mha with the voxels inside, .mhd with the voxels beside.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens a scalar volume of three axes, or of two as one slice; axes of size 1 beyond that are dropped. The
/// voxels may be binary of either byte order, ASCII or compressed, and lie in the file itself (LOCAL), in one other
/// file, in a LIST of files or in numbered files.
///
/// World space is what Offset, TransformMatrix (one axis of the image after the other) and ElementSpacing say, in mm
/// (or less, where voxels are small) where DistanceUnits is known; it is recorded as LPS, the convention of ITK, whose
/// format this is. ElementToIntensityFunctionSlope and ...Offset are applied. CenterOfRotation moves nothing: Offset is
/// the place of the first voxel. Format: https://itk.org/Wiki/ITK/MetaIO/Documentation
///
/// @param strict  refuses a data file beside the header that is longer than this says, which else is noted
/// @throw IoError  a file is missing, short, long or malformed
/// @throw SeveralParts  several channels or a fourth axis, and `parts` chooses none
std::unique_ptr<VoxelSource> openMetaImage(const std::filesystem::path& path, bool strict = false,
                                           const PartChoice& parts = {}, bool besideOnly = false);

}  // namespace umbrick
