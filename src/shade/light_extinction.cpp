// SPDX-License-Identifier: Apache-2.0
#include "shade/light_extinction.h"

namespace umbrick {

void LightExtinction::begin(const Frame& frame, const LightPlan& plan) {
  const LightGeometry& geometry = plan.geometry;
  if (!polygons_) polygons_.emplace(frame.gl);
  if (size_ != geometry.lattice.size || layers_ != plan.runs.slicesTogether)
    makeTexture(frame.gl, geometry.lattice.size, plan.runs.slicesTogether);
  ShaderConstants constants = slabConstants(frame);
  constants["kPerspective"] = 0;  // light is seen in parallel projection even where the eye's view is perspective
  setSlabUniforms(program_.get(frame.gl, constants), frame, geometry.view, geometry.planes);
}

void LightExtinction::makeTexture(const GlFunctions& gl, const glm::ivec2& size, int layers) {
  layers_ = 0;  // no layers count as made until all of this has worked
  texture_ = makeTextureArray(gl, GL_R32F, size.x, size.y, layers, GL_NEAREST);
  target_ = makeFramebuffer(gl, {texture_.name()});
  size_ = size;
  layers_ = layers;
}

void LightExtinction::fill(const Frame& frame, const LightPlan& plan, std::int64_t first, std::int64_t last,
                           std::span<const int> layers) {
  polygons_->fill(plan.geometry.slices, first, last, plan.geometry.view, frame.bricks, frame.reverseBricks, layers);
}

void LightExtinction::clearTexture(const GlFunctions& gl) const {
  const float nothing[4] = {};
  gl.Disable(GL_SCISSOR_TEST);
  gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.ClearNamedFramebufferfv(target_.name(), GL_COLOR, 0, nothing);
}

void LightExtinction::draw(Frame& frame, const LightRun& run) {
  const GlFunctions& gl = frame.gl;
  clearTexture(gl);
  const std::span<const SliceDraw> draws = polygons_->drawsOf(run.slices.front(), run.slices.back() + 1);
  if (draws.empty()) return;
  gl.BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl.Viewport(0, 0, size_.x, size_.y);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disablei(GL_BLEND, 0);
  program_.current().use();
  polygons_->bind();
  frame.fragments.begin();
  for (std::size_t i = 0; i < draws.size();) {
    // One call draws all slices that follow each other in the same texture of the atlas.
    SliceDraw merged = draws[i];
    for (++i; i < draws.size() && draws[i].texture == merged.texture; ++i) merged.indices += draws[i].indices;
    bindVolume(frame, merged.texture);
    polygons_->draw(merged.firstIndex, merged.indices);
  }
  frame.fragments.end();
}

}  // namespace umbrick
