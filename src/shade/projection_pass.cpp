// SPDX-License-Identifier: Apache-2.0
#include "shade/projection_pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "shade/constants.h"
#include "umbrick/draw/value_picture.h"

namespace umbrick {
namespace {

// Rays along a face of the box count as in it, whatever rounding makes of them.
constexpr double kFaceMargin = 1e-4;

// The box of voxel centres: the volume's domain has one more voxel of background around it.
Box boxOf(const Bricks& volume) { return {glm::dvec3(volume.domain.min + 1), glm::dvec3(volume.domain.max - 1)}; }

int kindOf(Mode mode) { return mode == Mode::mip ? 0 : mode == Mode::minip ? 1 : 2; }

}  // namespace

void ProjectionPass::begin(const ValueScene& rays, int perVoxel) {
  const GlFunctions& gl = rays.gl;
  if (!nothing_) nothing_.emplace(gl);
  const glm::ivec2 size = rays.view.size;
  if (size_ != size) {
    target_ = makeTexture2d(gl, GL_RGBA32F, size.x, size.y, GL_NEAREST);
    framebuffer_ = makeFramebuffer(gl, {target_.name()});
    size_ = size;
  }
  mode_ = rays.scene.mode;
  background_ = rays.volume.background;
  codes_ = rays.codes;
  const double start = mode_ == Mode::average ? 0 : -std::numeric_limits<double>::infinity();
  found_.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), Found{start, 0, 0});
  ShaderConstants constants{{"kPerspective", rays.view.projection == Projection::perspective},
                            {"kClipPlanes", static_cast<int>(rays.planes.size())},
                            {"kTextures", std::clamp(rays.bricks.atlas().textureCount(), 1, kRayTextures)},
                            {"kEnds", rays.ends != nullptr},
                            {"kProjection", kindOf(mode_)},
                            {"kPerVoxel", perVoxel}};
  rays.codes.setConstants(constants);
  GlProgram& program = program_.get(gl, constants);
  rays.codes.setUniforms(program);
  program.set("depth", -0.6f);
}

void ProjectionPass::draw(const ValueScene& rays, const RayFrame& frame, const RayRun& run, RenderStats& stats) {
  const GlFunctions& gl = rays.gl;
  slots_.fill(gl, rays.bricks, run.cells);
  const Box box = boxOf(rays.volume);
  GlProgram& program = program_.current();
  frame.setUniforms(program, rays.view, rays.planes, {box.min - kFaceMargin, box.max + kFaceMargin});
  frame.setCells(program, run.cells.cells, run.cells.parts);
  const glm::dvec3 origin = glm::dvec3(frame.bricks.first) + frame.corner;
  program.set("box_low", glm::vec3(box.min - origin));
  program.set("box_high", glm::vec3(box.max - origin));
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  gl.Viewport(0, 0, size_.x, size_.y);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disablei(GL_BLEND, 0);
  gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.Disable(GL_SCISSOR_TEST);
  const glm::vec4 nothing(0);
  gl.ClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, &nothing.x);
  gl.BindTextureUnit(kSlotsUnit, slots_.texture());
  gl.BindTextureUnit(kBoundsUnit, slots_.bounds());
  if (rays.ends) gl.BindTextureUnit(kEndUnit, rays.ends->name());
  bindVoxels(gl, rays.bricks.atlas(), run.cells.textures);
  program.use();
  gl.BindVertexArray(nothing_->name());
  const Stopwatch sweep;
  drawPixels(gl, pixelsOf(rays.view, run.cells.cells, frame.interior / run.cells.parts, frame.corner), run,
             rays.progress);
  gl.Finish();
  stats.sweepMs += sweep.elapsedMs();
  collect(gl, stats);
}

// Adds what a run has found.
void ProjectionPass::collect(const GlFunctions& gl, RenderStats& stats) {
  const Stopwatch read;
  const Image image = readTexture(gl, target_, size_.x, size_.y);
  double samples = 0;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const float* const pixel = &image.pixels[4 * i];
    if (!(pixel[3] > 0)) continue;
    Found& found = found_[i];
    if (mode_ == Mode::average)
      found.best += static_cast<double>(pixel[0]);
    else
      found.best = std::max(found.best, static_cast<double>(pixel[0]));
    found.covered += static_cast<double>(pixel[2]);
    found.way = std::max(found.way, static_cast<double>(pixel[3]));
    samples += static_cast<double>(pixel[1]);
  }
  stats.fragments += static_cast<std::uint64_t>(samples);
  stats.readMs += read.elapsedMs();
}

// A ray that leaves the bricks meets empty space.
double ProjectionPass::valueOf(const Found& found) const {
  if (!(found.way > 0)) return background_;
  if (mode_ == Mode::average) return background_ + (codes_->toValue(found.best) - codes_->toValue(0)) / found.way;
  const bool meetsNothing = found.covered < found.way;
  if (mode_ == Mode::mip) {
    const double most = codes_->toValue(found.best);
    return meetsNothing ? std::max(most, background_) : most;
  }
  const double least = codes_->toValue(-found.best);
  return meetsNothing ? std::min(least, background_) : least;
}

void ProjectionPass::show(const ResolvedScene& scene, Picture& picture) const {
  const int width = scene.camera.width;
  picture.colour = Image(width, scene.camera.height);
  Image values(width, scene.camera.height, 1);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.pixels.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      values.pixels[i] = static_cast<float>(valueOf(found_[i]));
      storeProjected(scene, values.pixels[i], background_, &picture.colour.pixels[4 * i]);
    }
  });
  picture.layers.push_back({"value", std::move(values), true});
}

std::uint64_t ProjectionPass::bytes() const {
  return slots_.bytes() + 16 * static_cast<std::uint64_t>(size_.x) * static_cast<std::uint64_t>(size_.y);
}

}  // namespace umbrick
