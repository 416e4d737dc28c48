// SPDX-License-Identifier: Apache-2.0
#include "shade/light_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shade/constants.h"

namespace umbrick {
namespace {

// Occlusion below this counts as none. It is a third of what kWalkReach leaves out.
constexpr float kImperceptible = 1e-5f;

// Returns, for each tile, the first and the last slice that may cover it.
std::vector<glm::vec2> coveringSlices(const ProxySlices& slices, const glm::ivec2& tiles, const glm::ivec2& size,
                                      int tileEdge) {
  std::vector<glm::vec2> covered(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y),
                                 glm::vec2(std::numeric_limits<float>::max(), -1.0f));
  for (std::int64_t i = 0; i < slices.count(); ++i)
    for (int p = slices.start[static_cast<std::size_t>(i)]; p < slices.start[static_cast<std::size_t>(i) + 1]; ++p) {
      const ScreenRegion region = coveredRegion(slices, p, p + 1, size);
      for (int y = region.min.y / tileEdge; y * tileEdge < region.max.y; ++y)
        for (int x = region.min.x / tileEdge; x * tileEdge < region.max.x; ++x) {
          glm::vec2& tile =
              covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.x) + static_cast<std::size_t>(x)];
          tile.x = std::min(tile.x, static_cast<float>(i));
          tile.y = static_cast<float>(i);
        }
    }
  return covered;
}

}  // namespace

LightTiles::LightTiles(const GlFunctions& gl)
    : state_(gl, "shade/full_screen.vert", "shade/tile_state.frag", {{"kTileEdge", kTileEdge}}),
      dilate_(gl, "shade/full_screen.vert", "shade/tile_dilate.frag"),
      mark_(gl, "shade/full_screen.vert", "shade/tile_mark.frag", {{"kTileEdge", kTileEdge}}),
      nothing_(gl) {}

void LightTiles::begin(const Frame& frame, std::span<const SliceStep> steps) {
  const GlFunctions& gl = frame.gl;
  const glm::ivec2 tiles = (frame.size() + kTileEdge - 1) / kTileEdge;
  if (tiles != tileCount_) {
    tileCount_ = tiles;
    coveredBy_ = makeTexture2d(gl, GL_RG32F, tiles.x, tiles.y, GL_NEAREST);
    for (int i = 0; i < 2; ++i) {
      tiles_[i] = makeTexture2d(gl, GL_RG8, tiles.x, tiles.y, GL_NEAREST);
      targets_[i] = makeFramebuffer(gl, {tiles_[i].name()});
    }
  }
  const std::vector<glm::vec2> covered = coveringSlices(frame.slices, tiles, frame.size(), kTileEdge);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TextureSubImage2D(coveredBy_.name(), 0, 0, 0, tiles.x, tiles.y, GL_RG, GL_FLOAT, covered.data());
  steps_.assign(steps.begin(), steps.end());
}

LightTiles::Way LightTiles::way(std::int64_t from, std::int64_t to) const {
  Way way;
  double variance = 0, radius = 0;
  for (std::int64_t i = to; i > from; --i) {
    const SliceStep& step = steps_[static_cast<std::size_t>(i)];
    variance = variance * step.scale * step.scale + step.deviation * step.deviation;
    way.scale *= step.scale;
    radius = step.radius;
  }
  // The first steps do not add up to a Gaussian yet, so two of them count in full.
  way.reach = kWalkReach * std::sqrt(variance) + 2 * (radius + 1);
  return way;
}

void LightTiles::look(const Frame& frame, std::int64_t slice, const GlTexture& occlusion) {
  const GlFunctions& gl = frame.gl;
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_SCISSOR_TEST);
  gl.Disablei(GL_BLEND, 0);
  gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.Viewport(0, 0, tileCount_.x, tileCount_.y);
  gl.BindVertexArray(nothing_.name());
  gl.BindTextureUnit(kOcclusionUnit, occlusion.name());
  gl.BindTextureUnit(kEyeUnit, frame.targets.eye.name());
  gl.BindTextureUnit(kCoveredByUnit, coveredBy_.name());
  const std::int64_t count = frame.slices.count(), next = std::min(slice + kInterval, count);
  state_.set("saturation", static_cast<float>(frame.scene.sampling.saturation));
  state_.set("slice", static_cast<float>(slice));
  state_.set("next_look", static_cast<float>(next));
  state_.set("imperceptible", kImperceptible);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_[0].name());
  state_.use();
  gl.DrawArrays(GL_TRIANGLES, 0, 3);

  // What is visible until the last slice may need light from here, and what is dark here darkens other places until
  // the next look.
  const Way visible = way(slice, count - 1), dark = way(slice, next - 1);
  const double most = std::max(tileCount_.x, tileCount_.y);
  const auto inTiles = [&](double reach) { return static_cast<float>(std::min(std::ceil(reach / kTileEdge), most)); };
  dilate_.set("reach", glm::vec2(inTiles(visible.reach), inTiles(dark.reach)));
  dilate_.set("scale", glm::vec2(1 / visible.scale, dark.scale));
  dilate_.set("centre", glm::vec2(frame.view.axisPixel() / double(kTileEdge)));
  dilate(0, 1, {1, 0}, gl);
  dilate(1, 0, {0, 1}, gl);

  gl.Viewport(0, 0, frame.size().x, frame.size().y);
  gl.BindFramebuffer(GL_FRAMEBUFFER, frame.targets.depthOnly.name());
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_ALWAYS);
  gl.DepthMask(GL_TRUE);
  mark_.use();
  gl.BindTextureUnit(kTileStateUnit, tiles_[0].name());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.DepthMask(GL_FALSE);
}

void LightTiles::dilate(int from, int to, const glm::vec2& axis, const GlFunctions& gl) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_[to].name());
  gl.BindTextureUnit(kTileStateUnit, tiles_[from].name());
  dilate_.set("axis", axis);
  dilate_.use();
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace umbrick
