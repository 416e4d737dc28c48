// The scene of each frame of a job: what its keys say, seen from where the camera is by then.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <optional>

#include "frame_job.h"
#include "opened_scene.h"
#include "umbrick/scene/resolve.h"

namespace umbrick::tools {

class FrameScenes {
 public:
  /// @param opened     the scene of all frames; its volume is the first one, by which a share of the largest gradient
  ///                   becomes a gradient
  /// @param technique  that draws
  /// @param orbit      degrees that the camera goes around the volume over all frames; around the point that it looks
  ///                   at where it is placed by its eye
  /// @throw InvalidArgument  names a frame at which the scene cannot be drawn
  FrameScenes(const OpenedScene& opened, const FrameJob& job, Technique technique, double orbit);

  /// Tells whether more than the camera and the volume differs from frame to frame.
  bool haveKeys() const { return !scene_.tracks.empty(); }
  /// @param volume  null: the frame holds nothing, and is seen as the first volume is
  ResolvedScene at(const FrameJob::Frame& frame, const Volume* volume) const;
  /// Returns the camera between a frame and the next one. @param share  of the time between them, in [0, 1]
  Camera cameraAt(const FrameJob::Frame& frame, const Volume& volume, double share) const;
  /// Tells whether a volume shows something outside of the box that the camera was placed for.
  bool leavesView(const Volume& volume) const;

 private:
  void tellRolls(const FrameJob& job) const;
  ResolvedScene resolved(const Volume& volume, double number) const;
  Camera turned(const Camera& camera, double share) const;

  Scene scene_;
  std::optional<Box> seen_;
  Technique technique_;
  ResolvedScene first_;  // of the first volume
  bool oneVolume_;
  double step_, count_;  // between numbers of frames; of frames
  // The camera goes around what an orbit looks at, or else around the point that it looks at.
  glm::dvec3 centre_, axis_;
  double radians_;  // over all frames
};

}  // namespace umbrick::tools
