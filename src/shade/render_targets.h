// The buffers that a picture is made in.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "umbrick/gl/objects.h"
#include "umbrick/image/image.h"

namespace umbrick {

struct TargetOptions {
  int width = 0, height = 0;
  int eyeBits = 32;       // 32: float; 16: fixed point
  int occlusionBits = 0;  // likewise; 0: no occlusion buffers
  bool aux = false;       // visibility and depth
};

/// eye: RGBA, linear premultiplied. aux: R opacity-weighted visibility, G opacity-weighted depth, A opacity.
/// occlusion[2]: one channel, one slice reads one and writes the other.
struct RenderTargets {
  RenderTargets(const GlFunctions& gl, const TargetOptions& options);
  std::size_t bytes() const;
  /// Eye and aux to 0, occlusion to 1, depth to 1, stencil to 0.
  void clear(const GlFunctions& gl) const;

  TargetOptions options;
  GlTexture eye, aux, depthStencil;
  std::array<GlTexture, 2> occlusion;
  GlFramebuffer eyeOnly;                     // eye [, aux], depth
  GlFramebuffer depthOnly;                   // marks saturated pixels
  std::array<GlFramebuffer, 2> eyeAndLight;  // eye, occlusion[i] [, aux], depth
  std::array<GlFramebuffer, 2> lightOnly;    // occlusion[i], depth
};

/// All channels of an RGBA texture.
Image readTexture(const GlFunctions& gl, const GlTexture& texture, int width, int height);

}  // namespace umbrick
