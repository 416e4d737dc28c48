// What a scene's volume is read from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// Is called now and then with the share that is loaded; what it throws ends the loading.
using LoadProgress = std::function<void(double share)>;

struct VolumeFile {
  ScalarGrid grid;
  bool foreign = false;            // it is a grid of a file of grids
  std::string creator;             // what that file says of the program that wrote it
  std::vector<std::string> notes;  // what was chosen or guessed
  VolumeReference source;          // with what was chosen
};

/// @throw IoError, InvalidArgument  as Volume(VolumeReference)
VolumeFile readVolumeFile(const VolumeReference& reference, const LoadProgress& progress = {});

}  // namespace umbrick
