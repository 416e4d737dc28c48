// The world of a volume: which way its axes point in a patient, and in which unit it counts lengths.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct World {
  std::string space;       // "LPS", "RAS", ...; empty: the file does not say
  std::string lengthUnit;  // "mm", "um", ...; empty: the file does not say
  std::string of;          // what messages call it, "that of head.nii"
};

/// The world that the metadata of a volume state.
World worldOf(const VolumeInfo& info);

/// Returns `world` with what it does not state as `other` states it.
World completed(World world, const World& other);

/// Returns the matrix from one world to another. What either does not state stays as it is.
/// @param notes  gets a line for each change
glm::dmat4 worldChange(const World& from, const World& to, std::vector<std::string>& notes);

/// A volume brought to another world, which its metadata then state and its notes tell.
/// @param assumed  notes also tell what the volume does not state, so that its numbers are taken as they are
std::unique_ptr<VoxelSource> inWorld(std::unique_ptr<VoxelSource> source, const World& world, bool assumed);

/// A volume whose world has other axes. Of one that does not say which way its axes point, the numbers are taken for
/// that space.
/// @param space  three letters, as patientAxes() has them, or "file" for the axes of the file
/// @throw InvalidArgument  another one, or the file's own is not known by letters
std::unique_ptr<VoxelSource> inSpace(std::unique_ptr<VoxelSource> source, const std::string& space);

/// A volume whose world is in another unit, which its metadata then state.
/// @param unit  nm, um, mm, cm, m or "file"  @throw InvalidArgument  another one
std::unique_ptr<VoxelSource> inLengthUnit(std::unique_ptr<VoxelSource> source, const std::string& unit);

}  // namespace umbrick
