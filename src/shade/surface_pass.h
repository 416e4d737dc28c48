// Draws the surfaces that the rays of a picture meet, through one run of bricks after another, nearest first.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "shade/projection_pass.h"

namespace umbrick {

class SurfacePass {
 public:
  /// Is called before the first run of a picture. @param layers  whether show() fills in layers
  /// @throw InvalidArgument  as shadingLights
  void begin(const ValueScene& rays, bool layers);
  void draw(const ValueScene& rays, const RayFrame& frame, const RayRun& run, RenderStats& stats);
  /// Fills in the picture's colour and its layers. @param count  also the number of cells that were looked at
  void show(const GlFunctions& gl, const ResolvedScene& scene, const IndexView& view, bool count,
            Picture& picture) const;
  /// Returns the depth from which each ray sees the medium behind its surface, of a scene of the mode hybrid; see
  /// FirstSurfaces. @pre begin() with layers
  Image start(const GlFunctions& gl, const ResolvedScene& scene) const;
  std::uint64_t bytes() const;

 private:
  void makeTargets(const GlFunctions& gl, const glm::ivec2& size, bool layers);
  void showLayers(const GlFunctions& gl, const ResolvedScene& scene, const IndexView& view, Picture& picture) const;

  SpecialisedProgram program_{"shade/full_screen.vert", "shade/surface_march.frag"};
  std::optional<GlVertexArray> nothing_;  // an empty vertex array, since the core profile draws nothing without one
  // As surface_march.frag writes them; without layers, the last three are not made.
  GlTexture eye_, count_, depthSum_, normal_, nearest_;
  GlFramebuffer framebuffer_;
  glm::ivec2 size_{0};
  bool layers_ = false;
  SlotTable slots_;
  // Where places along rays begin, and their unit, world units.
  std::optional<double> firstDepth_;
  double depth_ = 1;
};

}  // namespace umbrick
