// What a scene's volume is read from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

struct VolumeFile {
  ScalarGrid grid;
  bool foreign = false;            // it is a grid of a file of grids
  std::string creator;             // what that file says of the program that wrote it
  std::vector<std::string> notes;  // what was chosen or guessed
  VolumeReference source;          // with what was chosen
};

/// @throw IoError, InvalidArgument  as Volume(VolumeReference)
VolumeFile readVolumeFile(const VolumeReference& reference);

}  // namespace umbrick
