// SPDX-License-Identifier: Apache-2.0
#include "shade/ray_pass.h"

#include <algorithm>
#include <cmath>

#include "shade/constants.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick {
namespace {

// Pixels [min, max).
struct PixelBox {
  glm::ivec2 min, max;
};

// Returns the pixels through which cells can be seen.
PixelBox pixelsOf(const IndexView& view, const CellBox& cells, const glm::ivec3& edge) {
  const PixelBox all{glm::ivec2(0), view.size};
  glm::dvec2 low(1e300), high(-1e300);
  for (unsigned c = 0; c < 8; ++c) {
    const glm::dvec3 corner =
        glm::dvec3(cells.first) - 0.5 +
        glm::dvec3(cells.count) * glm::dvec3(edge) * glm::dvec3(c & 1 ? 1 : 0, c & 2 ? 1 : 0, c & 4 ? 1 : 0);
    glm::dvec3 seen = view.toView(corner);
    if (view.projection == Projection::perspective) {
      if (!(seen.z > 0)) return all;  // the box reaches behind the eye
      seen /= seen.z;
    }
    const glm::dvec2 pixel =
        (glm::dvec2(seen) - view.centre + view.halfExtent) / (2.0 * view.halfExtent) * glm::dvec2(view.size);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  const glm::dvec2 size(view.size);
  return {glm::ivec2(glm::clamp(low - 1.0, glm::dvec2(0), size)),
          glm::ivec2(glm::clamp(high + 2.0, glm::dvec2(0), size))};
}

}  // namespace

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
                            {"kColoured", light && light->coloured()},
                            {"kAux", rays.targets.picture.options.aux}};
  rays.transfer.setConstants(constants);
  GlProgram& program = program_.get(rays.gl, constants);
  const BrickAtlas& atlas = rays.bricks.atlas();
  rays.transfer.setUniforms(program, atlas);
  if (light) program.set("whole_light", glm::vec3(light->whole()));
  program.set("apron", static_cast<float>(atlas.layout().apron));
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
  gl.Enable(GL_SCISSOR_TEST);
  for (const GLuint target : {0u, 1u, 2u}) {
    gl.ColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Enablei(GL_BLEND, target);
    gl.BlendFunci(target, target == 1 ? GL_ONE : GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  }
  gl.BindTextureUnit(kTransferUnit, rays.transfer.texture());
  gl.BindTextureUnit(kSlotsUnit, slots_.texture());
  for (std::size_t i = 0; i < run.cells.textures.size(); ++i) {
    const auto unit = static_cast<GLuint>(i);
    gl.BindTextureUnit(i == 0 ? kAtlasUnit : kMoreAtlasUnit + unit - 1,
                       rays.bricks.atlas().texture(run.cells.textures[i]));
    if (rays.light)
      gl.BindTextureUnit(i == 0 ? kLightUnit : kMoreLightUnit + unit - 1, rays.light->texture(run.cells.textures[i]));
  }
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
  const glm::ivec3 part = frame.interior / run.cells.parts;
  const CellBox& cells = run.cells.cells;
  program.set("part", glm::vec3(part));
  program.set("first_cell", glm::ivec3((cells.first - frame.bricks.first) / glm::i64vec3(part)));
  setState(rays, run);
  const PixelBox box = pixelsOf(rays.view, cells, part);
  // A long draw is cut into bands, so that somebody who waits hears of it; what is fast is cut into few.
  constexpr double kLongMs = 100;
  int rows = rays.progress ? 64 : box.max.y - box.min.y;
  for (int y = box.min.y; y < box.max.y;) {
    const int end = std::min(y + rows, box.max.y);
    gl.Scissor(box.min.x, y, box.max.x - box.min.x, end - y);
    const Stopwatch watch;
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    y = end;
    if (!rays.progress) continue;
    gl.Finish();
    if (watch.elapsedMs() < kLongMs) rows *= 2;
    rays.progress(run.done + run.share * (y - box.min.y) / (box.max.y - box.min.y));
  }
  gl.Disable(GL_SCISSOR_TEST);
}

}  // namespace umbrick
