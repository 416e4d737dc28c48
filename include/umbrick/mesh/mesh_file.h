// Reads meshes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/mesh/mesh.h"

namespace umbrick {

/// Reads a mesh of PLY, OBJ or STL, which the name ends in. Polygons become triangles; points and lines are left out,
/// and so are colours, materials and other files that the file names. Vertices without normals get those of the
/// triangles around them that turn by less than 40 degrees.
/// @throw IoError  the file is missing, longer than 1 GiB, none of these, damaged, or holds no triangle, or a vertex
///   is not finite: the message names the file
std::shared_ptr<const Mesh> readMesh(const std::filesystem::path& file);

}  // namespace umbrick
