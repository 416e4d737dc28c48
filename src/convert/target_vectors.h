// Grids of vec3 made ready for another program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include <glm/mat3x3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"

namespace umbrick {

/// How vectors are stored: scale * turn * vector, as halves where that was chosen. The background is found again
/// exactly.
struct VectorMap {
  glm::dmat3 turn{1};  // each axis becomes an axis, maybe the other way round
  double scale = 1;
  bool half = false;
  bool velocity = false;         // they may be velocities: no unit is stated for them, or one of length per time
  openvdb::Vec3f background{0};  // before
};

/// Changes place, values and metadata of a grid to what the target expects, and tells it in the report. Colours keep
/// their numbers, as half floats where the target takes values from 0 to 1. Vectors turn as the axes do. They are
/// lengths, or lengths per time, which follow the unit of length, unless the metadata value_unit say another thing
/// ("T", "N"); the factor is kept as metadata vector_scale.
VectorMap prepareVectors(const ConvertOptions& options, VoxelMeaning meaning, openvdb::Vec3SGrid& grid,
                         ConvertedGrid& report);

/// Returns the grid as it was before, up to rounding.
openvdb::Vec3SGrid::ConstPtr unmapped(const openvdb::Vec3SGrid::ConstPtr& grid, const std::optional<VectorMap>& map);

struct NamedVectors {
  openvdb::Vec3SGrid* grid = nullptr;
  VoxelMeaning meaning = VoxelMeaning::vector;
  bool velocity = true;  // as VectorMap has it
};

/// Gives the first velocities and the first colours the names under which the target looks for them, unless a grid of
/// the file has that name.
/// @return a line for each new name
std::vector<std::string> nameVectors(Target target, const std::vector<NamedVectors>& vectors,
                                     const openvdb::GridCPtrVec& all);

}  // namespace umbrick
