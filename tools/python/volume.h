// A volume as Python holds it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/ingest/voxel_source.h"
#include "umbrick/render/volume.h"

namespace umbrick::python {

struct [[gnu::visibility("hidden")]] VolumeHandle {
  std::shared_ptr<const Volume> volume;
  std::optional<VoxelType> type;   // of the voxels that it was made of, where they are known
  std::vector<std::string> notes;  // what was chosen, guessed or left out, a line each
  pybind11::dict losses;           // of a conversion
  bool ofFile = false;             // it is what a file holds, as it stands there
};

void addVolume(pybind11::module_& module);

}  // namespace umbrick::python
