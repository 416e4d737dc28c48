// Stacks of images: TIFF of one or many pages, and PNG.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens images as the slices of a volume, the first row of each at y = 0. `path` is
/// - a TIFF of one or many pages, or one PNG,
/// - a name with one number in it, "slice_%04d.tif": all files of that name, without a gap,
/// - a name with * or ?: all files that fit, in the order of the numbers in their names,
/// - a folder that holds images of one kind.
/// Pixels are grey, with opacity or not, or colours (RGB, a palette of PNG), integers or floats of 8 to 64 bits; a TIFF
/// may have strips or tiles and every compression that libtiff unpacks. Its reduced pages (thumbnails) are passed over.
/// One image is held at a time.
///
/// Images state no place: pixels are 1 apart and the first is at 0, except that ImageJ's TIFF states unit, resolution
/// and spacing. Values are those that are stored, even where 0 stands for white; the metadata then say so.
///
/// @throw SeveralParts  colours, of which `parts` chooses no component
/// @throw IoError       no file, a gap in the numbers, unreadable, a palette of TIFF, or images of different sizes or
/// types
std::unique_ptr<VoxelSource> openImageStack(const std::filesystem::path& path, const PartChoice& parts = {},
                                            bool besideOnly = false);

/// True for a pattern of names, and for a folder with images.
bool isImageStack(const std::filesystem::path& path);

}  // namespace umbrick
