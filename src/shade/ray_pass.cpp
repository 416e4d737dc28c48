// SPDX-License-Identifier: Apache-2.0
#include "shade/ray_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "shade/constants.h"
#include "shade/phong_uniforms.h"
#include "umbrick/light/light_paths.h"
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
                            {"kConeRays", !rays.coneLights.empty()},
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
  if (!rays.coneLights.empty()) takeLights(rays);
  rays.codes.setUniforms(program);
  setPhongUniforms(program, rays.scene, rays.volume.indexToWorld);
  program.set("inverse_size", glm::vec3(1.0 / glm::dvec3(atlas.textureSize())));
  program.set("saturation", static_cast<float>(rays.scene.sampling.saturation));
  program.set("depth", -0.6f);  // in front of what is clear, behind what is marked as saturated
}

// Writes the lights' directions in steps of a voxel along the axis that each follows most.
void RayPass::takeLights(const RayScene& rays) {
  const GlFunctions& gl = rays.gl;
  const glm::dmat3 toIndex = glm::inverse(glm::dmat3(rays.volume.indexToWorld));
  const glm::dvec3 whole = wholeLight(rays.coneLights);
  const double power = whole.r + whole.g + whole.b;
  std::vector<glm::vec4> steps, radiances;
  for (const LightDirection& light : rays.coneLights) {
    const glm::dvec3 along = toIndex * light.direction, size = glm::abs(along);
    const double length = 1 / std::max({size.x, size.y, size.z});
    const glm::dvec3& radiance = light.radiance;
    steps.emplace_back(length * along, length);
    radiances.emplace_back(radiance, power > 0 ? (radiance.r + radiance.g + radiance.b) / power : 0);
  }
  const auto count = static_cast<int>(steps.size());
  coneLights_ = makeTexture2d(gl, GL_RGBA32F, count, 2, GL_NEAREST);
  gl.TextureSubImage2D(coneLights_.name(), 0, 0, 0, count, 1, GL_RGBA, GL_FLOAT, steps.data());
  gl.TextureSubImage2D(coneLights_.name(), 0, 0, 1, count, 1, GL_RGBA, GL_FLOAT, radiances.data());
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
  if (!rays.coneLights.empty()) gl.BindTextureUnit(kConeLightsUnit, coneLights_.name());
  if (rays.light) bindLight(gl, *rays.light, run.cells.textures);
  program_.current().use();
  gl.BindVertexArray(nothing_->name());
}

// How many segments are drawn at once. Mesa's software renderer ends all loops of a shader after so many turns in all,
// and GPUs are not to be kept for too long. A ray towards the light takes a turn for each of its steps, for each piece
// of a transfer function in it and for each cell.
double RayPass::segmentsAtOnce(const RayScene& rays, const RayFrame& frame) {
  if (rays.coneLights.empty()) return static_cast<double>(frame.count);
  return std::max(1.0, std::floor(kMostTurns / (4 * stepsToLight(rays, frame))));
}

double RayPass::stepsToLight(const RayScene& rays, const RayFrame& frame) {
  const glm::i64vec3 voxels = frame.bricks.count * glm::i64vec3(frame.interior);
  return static_cast<double>(rays.coneLights.size()) * static_cast<double>(std::max({voxels.x, voxels.y, voxels.z}));
}

void RayPass::draw(const RayScene& rays, const RayFrame& frame, const RayRun& run) {
  slots_.fill(rays.gl, rays.bricks, run.cells);
  GlProgram& program = program_.current();
  frame.setUniforms(program, rays.view, rays.planes, rays.medium);
  frame.setCells(program, run.cells.cells, run.cells.parts);
  const glm::dmat4& toWorld = rays.volume.indexToWorld;
  program.set("from_eye", glm::vec3(glm::dvec3(toWorld * glm::dvec4(frame.bricks.first, 1)) - rays.scene.camera.eye));
  const PixelBox pixels = pixelsOf(rays.view, run.cells.cells, frame.interior / run.cells.parts, frame.corner);
  const double all = static_cast<double>(frame.count), atOnce = segmentsAtOnce(rays, frame);
  RayRun part = run;
  for (double first = 0; first < all; first += atOnce) {
    endSaturated(rays);
    program.set("drawn_segments", glm::vec2(first, first + atOnce));
    setState(rays, run);
    part.done = run.done + run.share * first / all;
    part.share = run.share * std::min(atOnce / all, 1.0);
    drawPixels(rays.gl, pixels, part, rays.progress);
  }
}

// Excludes pixels in which next to nothing is seen behind what is drawn.
void RayPass::endSaturated(const RayScene& rays) {
  const double saturation = rays.scene.sampling.saturation;
  if (!first_ && saturation > 0) {
    if (!saturation_) saturation_.emplace(rays.gl);
    saturation_->run(rays.gl, rays.targets.picture, saturation);
  }
  first_ = false;
}

}  // namespace umbrick
