// SPDX-License-Identifier: Apache-2.0
#include "shade/frame.h"

#include <algorithm>
#include <glm/vec4.hpp>

#include "shade/constants.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

void FragmentCounter::begin() {
  if (!enabled_) return;
  queries_.emplace_back(gl_, static_cast<GLenum>(GL_SAMPLES_PASSED));
  gl_.BeginQuery(GL_SAMPLES_PASSED, queries_.back().name());
}
void FragmentCounter::end() {
  if (enabled_) gl_.EndQuery(GL_SAMPLES_PASSED);
}
std::uint64_t FragmentCounter::total() const {
  std::uint64_t sum = 0;
  for (const GlQuery& query : queries_) {
    GLuint64 passed = 0;
    gl_.GetQueryObjectui64v(query.name(), GL_QUERY_RESULT, &passed);
    sum += passed;
  }
  return sum;
}

void SweepProgress::begin(std::int64_t slices, const glm::ivec2& size, double done, double share) {
  // So many pixels are drawn in a fraction of a second, for which a driver may be kept waiting: a wait costs little
  // beside them.
  constexpr std::int64_t kPixels = std::int64_t{1} << 23;
  constexpr std::int64_t kMostSlices = 64;
  slices_ = std::max<std::int64_t>(1, slices);
  interval_ = std::clamp<std::int64_t>(kPixels / (std::int64_t{size.x} * size.y), 1, kMostSlices);
  told_ = 0;
  done_ = done;
  share_ = share;
}

void SweepProgress::reached(std::int64_t slice) {
  if (!report_ || slice < told_ + interval_) return;
  told_ = slice;
  gl_.Finish();
  report_(done_ + share_ * static_cast<double>(slice) / static_cast<double>(slices_));
}

ShaderConstants slabConstants(const Frame& frame) {
  ShaderConstants constants{{"kPerspective", frame.camera.projection == Projection::perspective},
                            {"kClipPlanes", static_cast<int>(frame.planes.size())},
                            {"kSegments", frame.scene.sampling.segments},
                            {"kAux", frame.targets.options.aux},
                            {"kStack", !frame.stack         ? 0
                                       : frame.stack->alone ? 1
                                                            : 2}};
  frame.transfer.setConstants(constants);
  return constants;
}

void setSlabUniforms(GlProgram& program, const Frame& frame) {
  setSlabUniforms(program, frame, frame.view, frame.planes);
}

void setSlabUniforms(GlProgram& program, const Frame& frame, const IndexView& view,
                     std::span<const glm::dvec4> planes) {
  const glm::dvec3 size(frame.atlas.textureSize());
  const glm::dvec2 pixel = 2.0 * view.halfExtent / glm::dvec2(view.size);
  program.set("screen_scale", glm::vec2(pixel));
  program.set("screen_offset", glm::vec2(view.centre - view.halfExtent));
  program.set("across_x", glm::vec3(view.toIndex[0] / size));
  program.set("across_y", glm::vec3(view.toIndex[1] / size));
  program.set("half_forward", glm::vec3(0.5 * frame.slices.spacing * view.toIndex[2] / size));
  program.set("half_spacing", static_cast<float>(0.5 * frame.slices.spacing));
  if (frame.stack) {
    program.set("stack_rate", glm::vec3(frame.stack->rate));
    program.set("stack_point", glm::vec2(frame.stack->point));
    program.set("per_view_depth", glm::vec3(view.toIndex[2] / size));
    program.set("index_right", glm::vec3(view.toIndex[0]));
    program.set("index_up", glm::vec3(view.toIndex[1]));
    program.set("index_forward", glm::vec3(view.toIndex[2]));
    program.set("stack_axis", frame.stack->axis);
    program.set("stack_sign", frame.stack->sign);
  }
  std::vector<glm::vec4> inShader;
  for (const glm::dvec4& plane : planes) inShader.emplace_back(plane);
  program.set("clip_planes", inShader);
  frame.transfer.setUniforms(program, frame.atlas);
  if (frame.scene.emitted) program.set("ambient", glm::vec3(lightScale(frame.scene)));
}

void SlicePass::fill(Frame& frame, std::int64_t first, std::int64_t last) {
  frame.polygons.fill(frame.slices, first, last, frame.view, frame.bricks, frame.reverseBricks);
}

void bindVolume(const Frame& frame, int texture) {
  frame.gl.BindTextureUnit(kAtlasUnit, frame.atlas.texture(texture));
  frame.transfer.bind(frame.gl);
}

SaturationTest::SaturationTest(const GlFunctions& gl)
    : program_(gl, "shade/full_screen.vert", "shade/saturated.frag"), nothing_(gl) {}

void SaturationTest::run(const GlFunctions& gl, const RenderTargets& targets, double saturation) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.depthOnly.name());
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_SCISSOR_TEST);
  gl.BindTextureUnit(kEyeUnit, targets.eye.name());
  program_.set("saturation", static_cast<float>(saturation));
  program_.set("depth", -1.0f);
  program_.use();
  gl.BindVertexArray(nothing_.name());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.DepthMask(GL_FALSE);
}

GlProgram& SpecialisedProgram::get(const GlFunctions& gl, const ShaderConstants& constants) {
  if (!program_ || constants != constants_)
    program_ = compute_.empty() ? std::make_unique<GlProgram>(gl, vertex_, fragment_, constants)
                                : std::make_unique<GlProgram>(GlProgram::compute(gl, compute_, constants));
  constants_ = constants;
  return *program_;
}

}  // namespace umbrick
