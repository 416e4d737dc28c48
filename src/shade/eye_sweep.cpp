// SPDX-License-Identifier: Apache-2.0
#include "shade/eye_sweep.h"

#include <algorithm>

namespace umbrick {
namespace {
// Returns the number of slices between two looks at which pixels are saturated. A look costs about as much as a slice
// of constant colour, and a pixel is shaded for half as many slices too long on average: the more a slice costs, the
// sooner a look pays.
std::int64_t saturationInterval(const ResolvedScene& scene) { return std::max(1, 8 / scene.sampling.segments); }
}  // namespace

void EyeSweep::begin(const Frame& frame) {
  if (frame.scene.sampling.saturation > 0 && !saturation_) saturation_.emplace(frame.gl);
  sinceTest_ = 0;
}

void EyeSweep::draw(Frame& frame, std::span<const SliceDraw> draws, const GlProgram& program) {
  setState(frame, program);
  const std::int64_t interval = saturationInterval(frame.scene);
  for (std::size_t i = 0; i < draws.size();) {
    if (frame.scene.sampling.saturation > 0 && sinceTest_ >= interval) {
      saturation_->run(frame.gl, frame.targets, frame.scene.sampling.saturation);
      setState(frame, program);
      sinceTest_ = 0;
    }
    // One call draws as many slices as lie in the same texture until the next look.
    SliceDraw merged = draws[i];
    std::size_t next = i + 1;
    for (; next < draws.size() && draws[next].texture == merged.texture; ++next) {
      if (draws[next].slice != draws[next - 1].slice && ++sinceTest_ >= interval) break;
      merged.indices += draws[next].indices;
    }
    if (next < draws.size() && draws[next].texture != merged.texture && draws[next].slice != draws[next - 1].slice)
      ++sinceTest_;
    bindVolume(frame, merged.texture);
    frame.fragments.begin();
    frame.polygons.draw(merged.firstIndex, merged.indices);
    frame.fragments.end();
    frame.progress.reached(draws[next - 1].slice);
    i = next;
  }
  if (!draws.empty()) ++sinceTest_;
}

void EyeSweep::setState(const Frame& frame, const GlProgram& program) {
  const GlFunctions& gl = frame.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.eyeOnly.name());
  gl.Viewport(0, 0, frame.camera.width, frame.camera.height);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_SCISSOR_TEST);
  for (const GLuint target : {0u, 1u}) {
    gl.ColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Enablei(GL_BLEND, target);
    gl.BlendFunci(target, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  }
  program.use();
  frame.polygons.bind();
}

}  // namespace umbrick
