// How the volume of a scene is opened.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/ingest/open_volume.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// Returns the options with which a volume is opened that a scene refers to.
/// @throw InvalidArgument  its headerless voxels are of a type that there is not
OpenOptions openOptions(const VolumeReference& reference);

}  // namespace umbrick
