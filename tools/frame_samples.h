// What is decided once for all frames of a sequence: the transfer function and the place of the camera.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/mat4x4.hpp>
#include <string>

#include "frame_job.h"
#include "opened_scene.h"

namespace umbrick::tools {

/// Looks at the first frame, the one in the middle and the last one, as far as the scene leaves anything open, and
/// completes the scene by them. Of the functions that are suggested for them it takes the one whose values reach
/// farthest, since a simulation that begins with next to nothing would else be shown by what it begins with; an orbit
/// looks at the box around what all of them show. At most two volumes are in memory at a time.
/// @param progress  of the volumes that are loaded, see Volume
/// @return the volume is that of the first frame that holds something
/// @throw UsageError, IoError, InvalidArgument  as openScene, and where no frame holds anything
OpenedScene openFrames(const SceneOptions& options, const FrameJob& job, const Scene& scene,
                       const std::function<void(double)>& progress);

/// Returns the box around what is visible of a volume with any of the scene's transfer functions.
/// @pre scene.transfer
Box visibleAtAnyKey(const Volume& volume, const Scene& scene);

/// What frames must have in common, so that one scene can show them.
struct FrameKind {
  std::string name;  // of the frame that it was taken from
  glm::dmat4 indexToWorld{1};
  bool levelSet = false;
  std::string unit;
};
FrameKind kindOf(const Volume& volume);
/// @throw InvalidArgument  names both frames and what differs
void requireAlike(const Volume& frame, const FrameKind& first);

}  // namespace umbrick::tools
