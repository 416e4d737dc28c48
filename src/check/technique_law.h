// The law that techniques agree: what slices draw on OpenGL is what rays on OpenGL, and techniques on the CPU, make of
// it, within the errors that both state.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "check/cut_volume.h"
#include "check/result.h"
#include "check/steps.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

class TechniqueLaw {
 public:
  /// How much work a view is, where a picture of slices is 1.
  static constexpr double kWork = 18;

  /// Everything outlives this.
  TechniqueLaw(const CutVolume& volume, CheckSteps& steps) : volume_(volume), steps_(steps) {}

  /// Draws progressive pictures of a scene by slices and by each other technique that can render it, and compares
  /// them: they may be apart by twice what they say they are off by together, since such an estimate may be half of the
  /// true error.
  /// @param slices    a renderer of the scene, which it has again in the end
  /// @param resident  the bricks that it draws
  /// @throw CheckStopped
  void check(Renderer& slices, ResidentVolume& resident, const std::string& where, double work,
             InvariantResult& result);

 private:
  /// Compares another technique. @param bySlices  is drawn where it is not yet
  void compare(Renderer& slices, std::optional<ProgressivePicture>& bySlices, Renderer& other, const std::string& where,
               InvariantResult& result) const;
  Renderer& rendererOf(Technique technique, const ResolvedScene& scene);

  const CutVolume& volume_;
  CheckSteps& steps_;
  std::unique_ptr<Bricks> bricks_;  // as techniques on the CPU need them
  std::map<Technique, std::unique_ptr<Renderer>> renderers_;
};

}  // namespace umbrick
