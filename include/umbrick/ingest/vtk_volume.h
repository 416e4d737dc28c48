// VTK images as volumes: ImageData of XML files (.vti), and structured points of legacy files (.vtk).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens an image with one scalar array on its points or its cells: the one that the file names as its scalars, or else
/// the only one of one component. Voxels of cells lie at their centres. Origin, spacing, direction and the start of the
/// extent become the transform.
/// - .vti: ascii, base64 and raw, inline and appended; plain or in blocks of zlib, LZ4 or LZMA; one piece
/// - .vtk: ASCII and binary
/// Format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
///
/// @throw IoError  missing, short, malformed, another kind of dataset, several pieces, vectors
std::unique_ptr<VoxelSource> openVti(const std::filesystem::path& path);
std::unique_ptr<VoxelSource> openLegacyVtk(const std::filesystem::path& path);

}  // namespace umbrick
