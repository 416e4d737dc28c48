// Programs that grids are made ready for: what each of them takes for granted of a .vdb.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "umbrick/core/axis.h"
#include "umbrick/core/names.h"

namespace umbrick {

enum class Target { blender, houdini, unreal, omniverse };
inline constexpr Name<Target> kTargets[]{{"blender", Target::blender},
                                         {"houdini", Target::houdini},
                                         {"unreal", Target::unreal},
                                         {"omniverse", Target::omniverse}};

/// What a program expects.
/// - Blender: metres, z up. Its principled volume looks for grids called density, color and temperature (Blender
///   manual, "Volumes, Introduction"). Its viewport and EEVEE put a volume into one 3D texture.
/// - Houdini: metres, y up, values as they are.
/// - Unreal Engine: centimetres, z up, left-handed; a sparse volume texture may hold 8-bit values from 0 to 1, has at
///   most 2048 tiles' texels along an axis and 2 GiB in all (SparseVolumeTextureUtility.h of Unreal Engine 5.3); its
///   transform has no shear, and all grids of a file share it.
/// - Omniverse, or any stage of OpenUSD that says nothing else: centimetres, y up (OpenUSD, metersPerUnit, upAxis).
/// Names of vectors: Blender takes the grid "velocity" for motion blur unless told otherwise (Blender Python API,
/// Volume.velocity_grid) and "color" in its principled volume; fields of Houdini's Pyro are "vel" and "Cd" (SideFX,
/// nodes/sop/pyrosolver and pyrobakevolume). Unreal asks for the grid of each channel as it imports a file (Epic,
/// "Sparse Volume Textures"), and a stage of OpenUSD names the grid of each field itself (OpenVDBAsset.fieldName), so
/// that any name does: they get Blender's, which people know.
struct TargetTraits {
  std::string_view name;       // for people
  double metresPerUnit = 1;    // of its world
  std::string_view unit;       // of its world: "m" or "cm"
  Axis up = Axis::z;           // and a thing faces usualFront(up)
  bool leftHanded = false;     // its world is a mirror image of ours
  bool unitValues = false;     // values of a fog go from 0 to 1, and 0 is what is left out
  std::int64_t longest = 0;    // voxels along an axis that it takes; 0: as many as there are
  std::int64_t mostBytes = 0;  // of its 16-bit texture; 0: as many as there are
  bool dense = false;          // that texture holds all of the box of the active voxels
  std::string_view velocity = "velocity", colour = "color";  // what its grids of vec3 are called
};

const TargetTraits& traitsOf(Target target);

}  // namespace umbrick
