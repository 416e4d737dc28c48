// NIfTI-1, NIfTI-2 and Analyze 7.5 volumes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens .nii, .nii.gz or a pair of .hdr and .img (either name); a volume of three axes, or of two as one slice.
/// Voxels may be integers of 8 to 64 bits or floats of 32 or 64, in either byte order. scl_slope and scl_inter are
/// applied.
///
/// World space is that of the sform where the file has one, sheared or not, or else that of the qform. Without either,
/// voxels lie pixdim apart and the first at 0. Lengths become mm, whichever unit xyzt_units names; an unknown one is
/// taken for mm. The space is RAS where the file has a form, and never converted. Analyze says nothing about its axes,
/// so no space is recorded.
/// Source: https://nifti.nimh.nih.gov/nifti-1/documentation/nifti1fields
///
/// The fourth axis counts frames, the fifth components, as those of a vector. Colours (RGB24, RGBA32) and complex
/// numbers have components side by side.
///
/// @param strict  refuses plain voxels behind which the file goes on, which else is noted
/// @throw SeveralParts  several frames or components, and `parts` chooses none
/// @throw IoError       missing, short, packed and long, malformed, more axes, or 128-bit voxels
std::unique_ptr<VoxelSource> openNifti(const std::filesystem::path& path, const PartChoice& parts = {},
                                       bool besideOnly = false, bool strict = false);

}  // namespace umbrick
