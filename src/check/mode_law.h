// The law that rays agree in all modes: projections and surfaces on OpenGL are those on the CPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "check/cut_volume.h"
#include "check/steps.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

class ModeLaw {
 public:
  /// How much work a view is, where a picture of slices is 1.
  static constexpr double kWork = 10;

  /// Everything outlives this.
  ModeLaw(const GlContext& context, const CutVolume& volume, CheckSteps& steps)
      : context_(context), volume_(volume), steps_(steps) {}

  /// Draws a scene in all modes but `integrate`, by rays on OpenGL and on the CPU, and compares: numbers of
  /// projections, as shares of the range of values, and the colours of a surface. They may be apart by twice what both
  /// change with half the distance between samples, and by what rounded places explain: see limitOf().
  /// @param scene  without light
  /// @throw CheckStopped
  void check(const ResolvedScene& scene, const std::string& where, InvariantResult& result);

 private:
  void prepare(const ResolvedScene& scene);
  Image drawn(Renderer& renderer, const ResolvedScene& scene) const;
  double limitOf(const ResolvedScene& scene, const Image& onGl, const Image& onCpu);

  const GlContext& context_;
  const CutVolume& volume_;
  CheckSteps& steps_;
  std::unique_ptr<Bricks> bricks_;
  std::unique_ptr<ResidentVolume> resident_;
  std::unique_ptr<Renderer> onGl_, onCpu_;
};

}  // namespace umbrick
