// VTK images as volumes: ImageData of XML files (.vti), and structured points of legacy files (.vtk).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens an array on the points or the cells of an image: the one that the path names, as in "file.vti:pressure", or
/// that the file names as its scalars, or else the only one that has one component, or the only one; of a .vtk the
/// first one that has one number for each point or cell, or else the first one. vtkGhostType is none of them. Values of
/// cells become voxels at the centres of the cells. Origin, spacing, direction and the start of the extent become the
/// transform.
/// - A .vti may hold its array as ascii, base64 or raw, inline or appended, plain or in blocks of zlib, LZ4 or
///   LZMA. It must have one piece.
/// - A .vtk may be ASCII or binary.
/// Format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
///
/// @throw SeveralParts  the array has several components, and `parts` chooses none
/// @throw IoError       missing, short, malformed, another kind of dataset, several pieces
std::unique_ptr<VoxelSource> openVti(const std::filesystem::path& path, const PartChoice& parts = {});
std::unique_ptr<VoxelSource> openLegacyVtk(const std::filesystem::path& path, const PartChoice& parts = {});

/// The array that a path such as "run/file.vti:pressure" names, where run/file.vti is a file; else nothing.
std::string vtkArrayName(const std::filesystem::path& path);

}  // namespace umbrick
