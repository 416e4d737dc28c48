// Directional occlusion shading: every slice reads the occlusion buffer of the slice before and writes its own.
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "shade/constants.h"
#include "shade/footprint.h"
#include "shade/frame.h"
#include "shade/light_tiles.h"

namespace umbrick {
namespace {

class OcclusionPass : public SlicePass {
 public:
  void begin(Frame& frame, std::span<const SweepRun>) override {
    const GlFunctions& gl = frame.gl;
    const DosOptions& options = frame.scene.occlusion.dos;
    disk_ = diskGrid(options.footprint);
    ShaderConstants constants = slabConstants(frame);
    constants["kTaps"] = static_cast<int>(disk_.size());
    constants["kAlgorithm"] = options.algorithm;
    if (spreadsFirst(frame)) {
      setSlabUniforms(blend_.get(gl, constants), frame);
    } else if (options.passes == 1) {
      setSlabUniforms(both_.get(gl, constants), frame);
    } else {
      setSlabUniforms(eye_.get(gl, constants), frame);
      setSlabUniforms(light_.get(gl, constants), frame);
    }
    spread_.get(gl, {{"kTaps", constants["kTaps"]}, {"kAlgorithm", options.algorithm}});
    if (!nothing_) nothing_ = GlVertexArray(gl);
    planRegions(frame);
    if (frame.scene.sampling.saturation > 0) {
      if (!tiles_) tiles_.emplace(gl);
      tiles_->begin(frame, steps_);
    } else {
      tiles_.reset();  // those of a scene before know nothing of these steps
    }
    previous_ = 0;
    stencil_ = 0;
    nextLook_ = 0;
  }

  void draw(Frame& frame, std::int64_t first, std::int64_t last) override {
    const std::vector<SliceDraw>& draws = frame.polygons.draws();
    std::size_t next = 0;
    for (std::int64_t slice = first; slice < last; ++slice) {
      const std::size_t begin = next;
      while (next < draws.size() && draws[next].slice == slice) ++next;
      drawSlice(frame, slice, std::span(draws).subspan(begin, next - begin));
      frame.progress.reached(slice);
    }
  }

 private:
  // Tells whether light is spread for all pixels before bricks are drawn. With one distance for all samples the mean
  // over the footprint does not depend on the medium. It is then taken for all pixels at once, which fills whole blocks
  // of a rasteriser where the polygons of small bricks do not, and bricks multiply it.
  static bool spreadsFirst(const Frame& frame) {
    return frame.scene.occlusion.dos.passes == 1 && frame.scene.occlusion.dos.algorithm == 3;
  }

  // Returns how slice i reads the slice before it, see footprint.glsl.
  SliceStep step(const Frame& frame, std::int64_t i) const {
    const double d = frame.slices.spacing;
    const double depth = frame.slices.depth(i);
    const double extent = d * std::tan(frame.scene.occlusion.aperture);  // Eq. 11
    const double pixel = 2 * frame.view.halfExtent.y / frame.camera.height;
    if (frame.view.projection == Projection::orthographic) return {1, extent / pixel, 0};
    if (!frame.scene.occlusion.dos.perspectiveCorrection) {
      // The length is that of a parallel view: the footprint keeps the size that it has at the point looked at.
      return {1, extent / (pixel * glm::length(frame.camera.lookAt - frame.camera.eye)), 0};
    }
    // The first slab has no slab before it: light is unoccluded wherever it is read.
    if (depth - d <= 0) return {1, 0, 0};
    return {depth / (depth - d), extent / (pixel * (depth - d)), 0};
  }

  void planRegions(const Frame& frame) {
    const std::size_t count = static_cast<std::size_t>(frame.slices.count());
    covered_.resize(count);
    steps_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      covered_[i] = coveredRegion(frame.slices, frame.slices.start[i], frame.slices.start[i + 1], frame.size());
      steps_[i] = step(frame, static_cast<std::int64_t>(i));
      steps_[i].deviation = deviation(steps_[i]);
    }
    regions_ = occlusionRegions(covered_, steps_, frame.size(), frame.view.axisPixel());
  }

  double deviation(const SliceStep& step) const {
    double square = 0;
    for (const glm::dvec2& point : disk_) square += 0.5 * glm::dot(point, point) / static_cast<double>(disk_.size());
    // Linear interpolation at a fraction f adds a variance of f (1 - f), which is a sixth of a squared
    // pixel on average.
    return std::sqrt(square * step.radius * step.radius + 1.0 / 6);
  }

  void setFootprint(GlProgram& program, const Frame& frame, const SliceStep& step) const {
    const glm::dvec2 texel = 1.0 / glm::dvec2(frame.size());
    program.set("texel_size", glm::vec2(texel));
    program.set("previous_scale", static_cast<float>(step.scale));
    program.set("view_axis", glm::vec2(frame.view.axisPixel() / glm::dvec2(frame.size())));
    const double tangent = std::tan(frame.scene.occlusion.aperture), d = frame.slices.spacing;
    std::vector<glm::vec4> taps;
    for (const glm::dvec2& point : disk_)
      taps.emplace_back(glm::vec2(point * step.radius * texel),
                        static_cast<float>(d * std::hypot(1, tangent * glm::length(point))), 0.0f);
    program.set("taps", taps);
  }

  void drawSlice(Frame& frame, std::int64_t slice, std::span<const SliceDraw> draws) {
    const GlFunctions& gl = frame.gl;
    const ScreenRegion& region = regions_[static_cast<std::size_t>(slice)];
    const SliceStep& step = steps_[static_cast<std::size_t>(slice)];
    if (draws.empty() && region.empty()) return;
    if (tiles_ && slice >= nextLook_) {
      tiles_->look(frame, slice, frame.targets.occlusion[static_cast<std::size_t>(previous_)]);
      nextLook_ = slice + LightTiles::kInterval;
    }
    const int target = 1 - previous_;
    if (!spreadsFirst(frame)) nextStencil(frame);
    gl.BindTextureUnit(kOcclusionUnit, frame.targets.occlusion[static_cast<std::size_t>(previous_)].name());
    if (spreadsFirst(frame)) {
      if (!region.empty()) drawSpread(frame, step, region, target, false);
      if (!draws.empty()) drawBoth(frame, blend_.current(), draws, step, target);
    } else if (frame.scene.occlusion.dos.passes == 1) {
      if (!draws.empty()) drawBoth(frame, both_.current(), draws, step, target);
      if (!region.empty()) drawSpread(frame, step, region, target, true);
    } else {
      if (!draws.empty()) drawEye(frame, draws, step);
      if (!draws.empty() && !region.empty()) drawLight(frame, draws, step, region, target);
      if (!region.empty()) drawSpread(frame, step, region, target, true);
    }
    previous_ = target;
  }

  // Chooses a number for this slice that no pixel of the stencil buffer holds yet.
  void nextStencil(const Frame& frame) {
    if (++stencil_ <= 255) return;
    const GlFunctions& gl = frame.gl;
    gl.Disable(GL_SCISSOR_TEST);
    gl.StencilMask(0xff);
    const GLint zero = 0;
    gl.ClearNamedFramebufferiv(frame.targets.depthOnly.name(), GL_STENCIL, 0, &zero);
    stencil_ = 1;
  }

  void setCommonState(const Frame& frame) const {
    const GlFunctions& gl = frame.gl;
    gl.Enable(GL_DEPTH_TEST);  // pixels that nothing needs any more have depth 0
    gl.DepthFunc(GL_LESS);
    gl.DepthMask(GL_FALSE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Enable(GL_STENCIL_TEST);
    gl.StencilMask(0xff);
    // Bricks mark their pixels with the slice's number; light is carried in the pixels that are left unmarked.
    gl.StencilFunc(GL_ALWAYS, stencil_, 0xff);
    gl.StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    for (GLuint i = 0; i < 3; ++i) gl.ColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }

  void blendUnder(const Frame& frame, GLuint target) const {
    frame.gl.Enablei(GL_BLEND, target);
    frame.gl.BlendFunci(target, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  }

  void drawTriangles(Frame& frame, std::span<const SliceDraw> draws) const {
    frame.polygons.bind();
    frame.fragments.begin();
    for (const SliceDraw& draw : draws) {
      bindVolume(frame, draw.texture);
      frame.polygons.draw(draw.firstIndex, draw.indices);
    }
    frame.fragments.end();
  }

  void drawBoth(Frame& frame, GlProgram& program, std::span<const SliceDraw> draws, const SliceStep& step, int target) {
    const GlFunctions& gl = frame.gl;
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.eyeAndLight[static_cast<std::size_t>(target)].name());
    setCommonState(frame);
    blendUnder(frame, 0);
    if (spreadsFirst(frame)) {
      gl.Disable(GL_STENCIL_TEST);
      gl.Enablei(GL_BLEND, 1);
      gl.BlendFunci(1, GL_ZERO, GL_SRC_COLOR);
    } else {
      gl.Disablei(GL_BLEND, 1);
    }
    blendUnder(frame, 2);
    setFootprint(program, frame, step);
    program.use();
    drawTriangles(frame, draws);
  }

  void drawEye(Frame& frame, std::span<const SliceDraw> draws, const SliceStep& step) {
    frame.gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.eyeOnly.name());
    setCommonState(frame);
    frame.gl.Disable(GL_STENCIL_TEST);
    blendUnder(frame, 0);
    blendUnder(frame, 1);
    setFootprint(eye_.current(), frame, step);
    eye_.current().use();
    drawTriangles(frame, draws);
  }

  void drawLight(Frame& frame, std::span<const SliceDraw> draws, const SliceStep& step, const ScreenRegion& region,
                 int target) {
    frame.gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.lightOnly[static_cast<std::size_t>(target)].name());
    setCommonState(frame);
    setScissor(frame, region);
    frame.gl.Disablei(GL_BLEND, 0);
    setFootprint(light_.current(), frame, step);
    light_.current().use();
    drawTriangles(frame, draws);
  }

  // Spreads light from the slice before.
  // @param spareBricks  leaves out the pixels that bricks of this slice have marked
  void drawSpread(const Frame& frame, const SliceStep& step, const ScreenRegion& region, int target, bool spareBricks) {
    const GlFunctions& gl = frame.gl;
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.lightOnly[static_cast<std::size_t>(target)].name());
    setCommonState(frame);
    setScissor(frame, region);
    if (spareBricks) {
      gl.StencilFunc(GL_NOTEQUAL, stencil_, 0xff);
      gl.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    } else {
      gl.Disable(GL_STENCIL_TEST);
    }
    gl.Disablei(GL_BLEND, 0);
    setFootprint(spread_.current(), frame, step);
    spread_.current().use();
    gl.BindVertexArray(nothing_.name());
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }

  static void setScissor(const Frame& frame, const ScreenRegion& region) {
    frame.gl.Enable(GL_SCISSOR_TEST);
    frame.gl.Scissor(region.min.x, region.min.y, region.extent().x, region.extent().y);
  }

  SpecialisedProgram blend_{"shade/slice.vert", "shade/occlusion_blend.frag"};
  SpecialisedProgram both_{"shade/slice.vert", "shade/occlusion_slice.frag"};
  SpecialisedProgram eye_{"shade/slice.vert", "shade/occlusion_eye.frag"};
  SpecialisedProgram light_{"shade/slice.vert", "shade/occlusion_light.frag"};
  SpecialisedProgram spread_{"shade/full_screen.vert", "shade/occlusion_spread.frag"};
  std::optional<LightTiles> tiles_;
  GlVertexArray nothing_;
  std::vector<glm::dvec2> disk_;
  std::vector<ScreenRegion> covered_, regions_;
  std::vector<SliceStep> steps_;
  int previous_ = 0;  // occlusion buffer that holds the slice before
  std::int64_t nextLook_ = 0;
  int stencil_ = 0;  // number of the slice in the stencil buffer, 1 to 255
};

}  // namespace

std::unique_ptr<SlicePass> makeOcclusionPass() { return std::make_unique<OcclusionPass>(); }

}  // namespace umbrick
