// What a scene's volume is read from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/ingest/volume_parts.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

struct OpenOptions;  // see ingest/open_volume.h

/// Is called now and then with the share that is loaded; what it throws ends the loading.
using LoadProgress = std::function<void(double share)>;

struct VolumeFile {
  ScalarGrid grid;
  bool foreign = false;            // it is a grid of a file of grids
  std::string creator;             // what that file says of the program that wrote it
  std::vector<std::string> notes;  // what was chosen or guessed
  VolumeReference source;          // with what was chosen
};

/// VolumeReference::grid may end in the part that is shown: ".x" (0, 1, ..., x, y, z, r, g, b, a or magnitude) one
/// number of voxels of several, as in "v.x" for a grid of vec3, and of a volume "[3]" the frame before it, as in
/// "[3].x".
/// @throw IoError, InvalidArgument  as Volume(VolumeReference)
VolumeFile readVolumeFile(const VolumeReference& reference, const LoadProgress& progress = {},
                          const std::shared_ptr<KeptStream>& kept = {});

/// Takes voxels in memory. @param name  what messages call them  @param open  has an array
VolumeFile readVolumeArray(const std::string& name, const OpenOptions& open, const LoadProgress& progress = {});

}  // namespace umbrick
