// Grids in another world: which way its axes point in a patient, and in which unit it counts lengths.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/world.h"

namespace umbrick {

/// The world that the metadata of a grid state.
World worldOf(const openvdb::GridBase& grid);

/// A grid that is brought to another world. It shares the voxels. A level set keeps its distances, so that one whose
/// unit changes is fit for a mask only.
/// @param notes  gets a line for each change
openvdb::FloatGrid::ConstPtr inWorld(const openvdb::FloatGrid::ConstPtr& grid, const World& world,
                                     std::vector<std::string>& notes);

/// Changes its space alone. Of a grid that does not state one, the numbers are taken for that space.
/// @param space  three letters, as patientAxes() has them, or "file" or nothing for no change
/// @throw InvalidArgument  another text
openvdb::FloatGrid::ConstPtr inSpace(const openvdb::FloatGrid::ConstPtr& grid, const std::string& space,
                                     std::vector<std::string>& notes);

}  // namespace umbrick
