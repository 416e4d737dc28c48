// The transfer function as the texture that shaders integrate it from, and the test of what can be seen through it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "shade/emission_lookup.h"
#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/brick/bricks.h"
#include "umbrick/gl/objects.h"
#include "umbrick/gl/program.h"
#include "umbrick/optics/transfer_stretches.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

class TransferLookup {
 public:
  /// @param format   of the atlas's texels
  /// @param emitted  of the volume's second grid, see ResolvedScene; none: nothing is
  /// @throw InvalidArgument  the function has more different control points along an axis than a texture of the driver
  ///   has texels, or than a quarter of that for a 2D function
  /// @throw GlError
  TransferLookup(const GlFunctions& gl, const TransferFunction& transfer, const SamplingOptions& sampling,
                 const Bricks& volume, VoxelFormat format, const std::optional<TransferFunction>& emitted = {});

  /// Returns false when no value (and gradient magnitude) in these ranges gives anything but 0, nor anything that
  /// rounding and the format of the texels may make of one.
  bool isVisible(const Range& value, const Range& gradient) const;
  /// The same, or whether values of the second grid emit something.
  bool isVisible(const Range& value, const Range& gradient, const Range& emission) const {
    return isVisible(value, gradient) || (emission_ && emission_->isVisible(emission));
  }
  /// Adds kQuadrature, kUniformStretches, kValueSteps, kGradientSteps and kEmission of shade/medium.glsl.
  void setConstants(ShaderConstants& constants) const;
  /// Sets the uniforms that medium.glsl needs to look up the atlas's texels.
  void setUniforms(GlProgram& program, const BrickAtlas& atlas) const;
  /// Binds the textures of both functions.
  void bind(const GlFunctions& gl) const;
  GLuint texture() const { return texture_.name(); }
  /// How many vectors of a shader's uniforms are left beside those of the transfer function and of what every pass has.
  std::size_t freeUniforms(const GlFunctions& gl) const;

 private:
  Range widened(const Range& values) const;

  TransferFunction transfer_;
  TexelScale scale_;
  float background_;
  double emptyRounding_;     // share of empty space's texel by which it may be read wrongly
  double gradientRounding_;  // the same for a gradient magnitude
  int mode_;
  int valueSteps_ = 0, gradientSteps_ = 0;  // steps of a bisection among the stretches of each axis
  std::vector<glm::vec4> uniforms_;         // rows 0 to 2 of the texture by column, where these are not too many
  GlTexture texture_;
  std::optional<EmissionLookup> emission_;
};

}  // namespace umbrick
