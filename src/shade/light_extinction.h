// Draws the optical depth of the slabs of a run of slices, as light meets them, on the lattice of the light.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "shade/frame.h"
#include "shade/light_plan.h"

namespace umbrick {

class LightExtinction {
 public:
  /// Is called before the first slice of a picture.
  void begin(const Frame& frame, const LightPlan& plan);
  /// Takes the polygons of slices [first, last), whose bricks are resident.
  /// @param layers  for each slice from `first`: its layer of the texture; negative: leave the slice out
  void fill(const Frame& frame, const LightPlan& plan, std::int64_t first, std::int64_t last,
            std::span<const int> layers);
  /// Draws the slices of a run into its layers of the texture.
  void draw(Frame& frame, const LightRun& run);
  /// Returns optical depth along the view axis, R32F, as large as the lattice, one layer for each slice of the run.
  const GlTexture& texture() const { return texture_; }

 private:
  void makeTexture(const GlFunctions& gl, const glm::ivec2& size, int layers);
  void clearTexture(const GlFunctions& gl) const;
  SpecialisedProgram program_{"shade/light_slice.vert", "shade/light_extinction.frag"};
  std::optional<PolygonBuffer> polygons_;
  glm::ivec2 size_{0};
  int layers_ = 0;
  GlTexture texture_;
  GlFramebuffer target_;
};

}  // namespace umbrick
