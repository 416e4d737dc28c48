#include "shade/light_need.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
namespace {

// The last slice that may cover each tile.
std::vector<float> lastSlices(const ProxySlices& slices, const glm::ivec2& tiles, const glm::ivec2& size,
                              int tileEdge) {
  std::vector<float> last(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y), -1.0f);
  for (std::int64_t i = 0; i < slices.count(); ++i)
    for (int p = slices.start[static_cast<std::size_t>(i)]; p < slices.start[static_cast<std::size_t>(i) + 1]; ++p) {
      const ScreenRegion covered = coveredRegion(slices, p, p + 1, size);
      for (int y = covered.min.y / tileEdge; y * tileEdge < covered.max.y; ++y)
        for (int x = covered.min.x / tileEdge; x * tileEdge < covered.max.x; ++x)
          last[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.x) + static_cast<std::size_t>(x)] =
              static_cast<float>(i);
    }
  return last;
}

}  // namespace

LightNeed::LightNeed(const GlFunctions& gl)
    : need_(gl, "shade/full_screen.vert", "shade/tile_need.frag", {{"kTileEdge", kTileEdge}}),
      dilate_(gl, "shade/full_screen.vert", "shade/tile_dilate.frag"),
      mark_(gl, "shade/full_screen.vert", "shade/unneeded.frag", {{"kTileEdge", kTileEdge}}),
      nothing_(gl) {}

void LightNeed::begin(const Frame& frame, std::span<const SliceStep> steps) {
  const GlFunctions& gl = frame.gl;
  const glm::ivec2 tiles = (frame.size() + kTileEdge - 1) / kTileEdge;
  if (tiles != tileCount_) {
    tileCount_ = tiles;
    lastSlice_ = makeTexture2d(gl, GL_R32F, tiles.x, tiles.y, GL_NEAREST);
    for (int i = 0; i < 2; ++i) {
      tiles_[i] = makeTexture2d(gl, GL_R8, tiles.x, tiles.y, GL_NEAREST);
      targets_[i] = makeFramebuffer(gl, {tiles_[i].name()});
    }
  }
  const std::vector<float> last = lastSlices(frame.slices, tiles, frame.size(), kTileEdge);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TextureSubImage2D(lastSlice_.name(), 0, 0, 0, tiles.x, tiles.y, GL_RED, GL_FLOAT, last.data());
  // From the last slice to the first: variances of the steps add, and a distance grows by the scale of each step.
  const std::size_t count = steps.size();
  reach_.assign(count, 0);
  growth_.assign(count, 1);
  double variance = 0;
  for (std::size_t i = count; i-- > 1;) {
    variance = variance * steps[i].scale * steps[i].scale + steps[i].deviation * steps[i].deviation;
    reach_[i - 1] = kWalkReach * std::sqrt(variance) + 2 * (steps[i].radius + 1);
    growth_[i - 1] = growth_[i] * steps[i].scale;
  }
}

void LightNeed::run(const Frame& frame, std::int64_t slice) {
  const GlFunctions& gl = frame.gl;
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_SCISSOR_TEST);
  gl.Disablei(GL_BLEND, 0);
  gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.Viewport(0, 0, tileCount_.x, tileCount_.y);
  gl.BindVertexArray(nothing_.name());
  gl.BindTextureUnit(3, frame.targets.eye.name());
  gl.BindTextureUnit(4, lastSlice_.name());
  need_.set("saturation", static_cast<float>(frame.scene.sampling.saturation));
  need_.set("slice", static_cast<float>(slice));
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_[0].name());
  need_.use();
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  const double reach = std::ceil(reach_[static_cast<std::size_t>(slice)] / kTileEdge);
  dilate_.set("reach", static_cast<float>(std::min<double>(reach, std::max(tileCount_.x, tileCount_.y))));
  dilate_.set("shrink", static_cast<float>(1 / growth_[static_cast<std::size_t>(slice)]));
  dilate_.set("centre", glm::vec2(frame.size()) * (0.5f / kTileEdge));
  dilate_.use();
  dilate_.set("axis", glm::vec2(1, 0));
  drawTiles(frame, dilate_, 0, 1);
  dilate_.set("axis", glm::vec2(0, 1));
  drawTiles(frame, dilate_, 1, 0);

  gl.Viewport(0, 0, frame.size().x, frame.size().y);
  gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.depthOnly.name());
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_TRUE);
  mark_.use();
  gl.BindTextureUnit(3, tiles_[0].name());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.DepthMask(GL_FALSE);
}

void LightNeed::drawTiles(const Frame& frame, GlProgram& program, int from, int to) {
  frame.gl.BindFramebuffer(GL_FRAMEBUFFER, targets_[to].name());
  frame.gl.BindTextureUnit(3, tiles_[from].name());
  program.use();
  frame.gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace umbrick
