// SPDX-License-Identifier: Apache-2.0
#include "shade/ray_pass.h"

#include <algorithm>
#include <cmath>

#include "shade/constants.h"
#include "shade/phong_uniforms.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

RayTargets::RayTargets(const GlFunctions& gl, const TargetOptions& options)
    : picture(gl, options), count(makeTexture2d(gl, GL_R32F, options.width, options.height, GL_NEAREST)) {
  all = options.aux
            ? makeFramebuffer(gl, {picture.eye.name(), count.name(), picture.aux.name()}, picture.depthStencil.name())
            : makeFramebuffer(gl, {picture.eye.name(), count.name()}, picture.depthStencil.name());
}

void RayTargets::clear(const GlFunctions& gl) const {
  picture.clear(gl);
  const glm::vec4 nothing(0);
  gl.ClearNamedFramebufferfv(all.name(), GL_COLOR, 1, &nothing.x);
}

std::uint64_t RayTargets::segments(const GlFunctions& gl) const {
  std::vector<float> each(pixels());
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.GetTextureImage(count.name(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(each.size() * sizeof(float)), each.data());
  std::uint64_t sum = 0;
  for (const float one : each) sum += static_cast<std::uint64_t>(one);
  return sum;
}

void RayPass::begin(const RayScene& rays) {
  first_ = true;
  if (!nothing_) nothing_.emplace(rays.gl);
  const ResidentLight* light = rays.light;
  ShaderConstants constants{{"kPerspective", rays.view.projection == Projection::perspective},
                            {"kClipPlanes", static_cast<int>(rays.planes.size())},
                            {"kTextures", std::clamp(rays.bricks.atlas().textureCount(), 1, kRayTextures)},
                            {"kLit", light != nullptr},
                            {"kStarts", rays.start != nullptr},
                            {"kEnds", rays.ends != nullptr},
                            {"kColoured", light && light->coloured()},
                            {"kAux", rays.targets.picture.options.aux}};
  rays.transfer.setConstants(constants);
  rays.codes.setConstants(constants);
  setPhongConstants(constants, rays.scene);
  GlProgram& program = program_.get(rays.gl, constants);
  const BrickAtlas& atlas = rays.bricks.atlas();
  rays.transfer.setUniforms(program, atlas);
  if (rays.scene.emitted) program.set("ambient", glm::vec3(lightScale(rays.scene)));
  if (light) program.set("whole_light", glm::vec3(light->whole()));
  rays.codes.setUniforms(program);
  setPhongUniforms(program, rays.scene, rays.volume.indexToWorld);
  program.set("inverse_size", glm::vec3(1.0 / glm::dvec3(atlas.textureSize())));
  program.set("saturation", static_cast<float>(rays.scene.sampling.saturation));
  program.set("depth", -0.6f);  // in front of what is clear, behind what is marked as saturated
}

void RayPass::setState(const RayScene& rays, const RayRun& run) {
  const GlFunctions& gl = rays.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, rays.targets.all.name());
  gl.Viewport(0, 0, rays.view.size.x, rays.view.size.y);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_STENCIL_TEST);
  for (const GLuint target : {0u, 1u, 2u}) {
    gl.ColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Enablei(GL_BLEND, target);
    gl.BlendFunci(target, target == 1 ? GL_ONE : GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  }
  rays.transfer.bind(gl);
  gl.BindTextureUnit(kSlotsUnit, slots_.texture());
  if (rays.start) gl.BindTextureUnit(kStartUnit, rays.start->name());
  if (rays.ends) gl.BindTextureUnit(kEndUnit, rays.ends->name());
  bindVoxels(gl, rays.bricks.atlas(), run.cells.textures);
  if (rays.light) bindLight(gl, *rays.light, run.cells.textures);
  program_.current().use();
  gl.BindVertexArray(nothing_->name());
}

void RayPass::draw(const RayScene& rays, const RayFrame& frame, const RayRun& run) {
  const GlFunctions& gl = rays.gl;
  const double saturation = rays.scene.sampling.saturation;
  if (!first_ && saturation > 0) {
    if (!saturation_) saturation_.emplace(gl);
    saturation_->run(gl, rays.targets.picture, saturation);
  }
  first_ = false;
  slots_.fill(gl, rays.bricks, run.cells);
  GlProgram& program = program_.current();
  frame.setUniforms(program, rays.view, rays.planes, rays.medium);
  frame.setCells(program, run.cells.cells, run.cells.parts);
  const glm::dmat4& toWorld = rays.volume.indexToWorld;
  program.set("from_eye", glm::vec3(glm::dvec3(toWorld * glm::dvec4(frame.bricks.first, 1)) - rays.scene.camera.eye));
  setState(rays, run);
  drawPixels(gl, pixelsOf(rays.view, run.cells.cells, frame.interior / run.cells.parts, frame.corner), run,
             rays.progress);
}

}  // namespace umbrick
