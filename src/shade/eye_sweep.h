// Blends slices into the eye buffer, nearest first, and leaves out the pixels that are saturated.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "shade/frame.h"

namespace umbrick {

class EyeSweep {
 public:
  void begin(const Frame& frame);
  /// Draws these slices, in order, with a program whose uniforms are set.
  void draw(Frame& frame, std::span<const SliceDraw> draws, const GlProgram& program);

 private:
  static void setState(const Frame& frame, const GlProgram& program);
  std::optional<SaturationTest> saturation_;
  std::int64_t sinceTest_ = 0;  // slices since the last look at which pixels are saturated
};

}  // namespace umbrick
