// Grids of any type in the world of another program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include <glm/mat3x3.hpp>
#include <string>
#include <vector>

#include "umbrick/convert/output_options.h"

namespace umbrick {

/// How a grid came into the world of a target: place there = scale * turn * place before.
struct TargetPlace {
  glm::dmat3 turn{1};  // each axis becomes an axis, maybe the other way round
  double scale = 1;
  double metresPerUnit = 1;  // of the lengths that the grid now has
  std::string unit;          // of these lengths: "m", or "1e-3 m" where OpenVDB holds no voxels that small
};

/// Length of "m", "cm", "mm", "um", "nm" or "pm" in metres; 0 for another text.
double metresOf(const std::string& unit);

/// Brings a grid into the world of output.target, in place and metadata. Its values stay.
/// @param foreign  it comes from a file of grids
/// @param notes    gets a line that says what was done
TargetPlace placeFor(const OutputOptions& output, bool foreign, openvdb::GridBase& grid,
                     std::vector<std::string>& notes);

/// Says where the target has a limit that a grid is beyond, and what keeps it.
/// @param scale      that the grid has been multiplied by
/// @param resamples  volumes of this kind can be resampled to a wider spacing
void tellLimits(const TargetTraits& target, const openvdb::GridBase& grid, double scale, bool resamples,
                std::vector<std::string>& notes);

}  // namespace umbrick
