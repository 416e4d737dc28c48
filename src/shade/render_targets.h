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
  int occlusionBits = 0;  // likewise; 0: there are no occlusion buffers
  bool aux = false;       // whether there is a buffer of visibility and depth
};

/// The buffers and their channels:
///   eye           RGBA, linear premultiplied
///   aux           R opacity-weighted visibility, G opacity-weighted depth, A opacity
///   occlusion[2]  one channel; a slice reads one of the two and writes the other
struct RenderTargets {
  RenderTargets(const GlFunctions& gl, const TargetOptions& options);
  std::size_t bytes() const;
  /// Sets eye and aux to 0, occlusion to 1, depth to 1 and stencil to 0.
  void clear(const GlFunctions& gl) const;

  TargetOptions options;
  GlTexture eye, aux, depthStencil;
  std::array<GlTexture, 2> occlusion;
  GlFramebuffer eyeOnly;                     // eye [, aux], depth
  GlFramebuffer depthOnly;                   // marks saturated pixels
  std::array<GlFramebuffer, 2> eyeAndLight;  // eye, occlusion[i] [, aux], depth
  std::array<GlFramebuffer, 2> lightOnly;    // occlusion[i], depth
};

/// Returns all channels of an RGBA texture.
Image readTexture(const GlFunctions& gl, const GlTexture& texture, int width, int height);

}  // namespace umbrick
