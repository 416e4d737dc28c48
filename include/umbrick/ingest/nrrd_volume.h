// NRRD volumes: attached (.nrrd) and detached (.nhdr) headers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens a scalar volume of three axes, or of two as one slice; axes of size 1 beyond that are dropped. The
/// voxels may be encoded as raw, gzip, bzip2, text or hex, and lie in the file itself, in one other file, in a list of
/// files or in numbered files.
///
/// World space is the space that the file names in its field `space` (LPS, RAS, ...); it is not converted. Its name and
/// the other fields of the header that do not change voxels are kept as metadata. Lengths become mm where their units
/// are known.
/// Format: https://teem.sourceforge.net/nrrd/format.html
///
/// @param strict  refuses a data file beside the header that is longer than this says, which else is noted
/// @throw IoError  a file is missing, short, long or malformed
/// @throw SeveralParts  axes of components, a list or time, and `parts` chooses none
std::unique_ptr<VoxelSource> openNrrd(const std::filesystem::path& path, bool strict = false,
                                      const PartChoice& parts = {}, bool besideOnly = false);

}  // namespace umbrick
