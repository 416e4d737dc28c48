// How far a level set is from the surface that it stands for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/mat4x4.hpp>

#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/isosurface.h"

namespace umbrick {

/// Sets crossings, maxError and rmsError of the report.
/// @param toLevelSet  from index coordinates of the volume to those of the level set
void measureIsosurface(const openvdb::FloatTree& volume, float value, const openvdb::FloatGrid& levelSet,
                       const glm::dmat4& toLevelSet, IsosurfaceReport& report);

}  // namespace umbrick
