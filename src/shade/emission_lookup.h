// What a second grid emits, as the texture that shaders look it up in.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/gl/objects.h"
#include "umbrick/gl/program.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// The function at equal steps of the value and its integral over them, see shaders/shade/glow.glsl.
class EmissionLookup {
 public:
  /// @param emitted  whose sigma_s is radiance per world unit
  EmissionLookup(const GlFunctions& gl, const TransferFunction& emitted);

  /// Returns false where no value of the range emits anything, nor one that lies a step beside it: steps of the
  /// function are spread over one.
  bool isVisible(const Range& values) const;
  void setUniforms(GlProgram& program) const;
  GLuint texture() const { return texture_.name(); }

 private:
  static constexpr int kSteps = 4096;
  TransferFunction emitted_;
  double first_ = 0, perUnit_ = 1;  // steps: (value - first) * perUnit
  GlTexture texture_;
};

}  // namespace umbrick
