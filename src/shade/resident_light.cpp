// SPDX-License-Identifier: Apache-2.0
#include "shade/resident_light.h"

#include <algorithm>
#include <utility>

#include "shade/constants.h"
#include "shade/view_planes.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

// Begins with a medium: adds the planes that cut it, and takes what is known of its light.
void ResidentLight::take(LightMedium& medium, const IndexView& view, std::span<const glm::dvec4> planes) {
  for (const glm::dvec4& plane : planes) {
    const glm::dvec4 inIndex = planeInIndex(plane, view);
    if (cutsMedium(inIndex, medium.cells, resident_.volume().layout.interior)) medium.planes.push_back(inIndex);
  }
  whole_ = wholeLight(medium.directions);
  coloured_ = isColoured(medium.directions);
  directions_ = medium.directions.size();
  note_.clear();
}

bool ResidentLight::wantsGl() const {
  return sweep_ == LightSweep::gl || (sweep_ == LightSweep::automatic && !resident_.context().software());
}

void ResidentLight::update(const ResolvedScene& scene, const RenderSample& sample, const IndexView& view,
                           std::span<const glm::dvec4> planes, const TransferLookup& transfer, BrickSelection& bricks) {
  const Stopwatch watch;
  LightMedium medium =
      lightInMedium(scene, lightsOf(scene, sample), {bricks.origins().begin(), bricks.origins().end()});
  take(medium, view, planes);
  if (wantsGl()) note_ = GlLightSweep::refusal(resident_, bricks, medium);
  const bool computed = wantsGl() && note_.empty() ? sweepOnGl(medium, transfer, bricks) : sweepOnCpu(medium, scene);
  ms_ += computed ? watch.elapsedMs() : 0;
}

void ResidentLight::updateSurfaces(const ResolvedScene& scene, const RenderSample& sample, const IndexView& view,
                                   std::span<const glm::dvec4> planes) {
  const Stopwatch watch;
  LightMedium medium = lightAtSurfaces(resident_.volume(), scene, lightsOf(scene, sample));
  take(medium, view, planes);
  if (wantsGl()) note_ = "the light of surfaces is computed on the CPU";
  ms_ += sweepOnCpu(medium, scene) ? watch.elapsedMs() : 0;
}

// @return whether light was computed
bool ResidentLight::sweepOnCpu(const LightMedium& medium, const ResolvedScene& scene) {
  const std::uint64_t most = std::max<std::uint64_t>(scene.bricks.budgetMiB << 20, std::uint64_t{2} << 30);
  const bool computed = light_.update(medium, most);
  // The textures may hold light of OpenGL.
  if (computed || swept_) ++version_;
  swept_.reset();
  whole_ = light_.whole();
  coloured_ = light_.coloured();
  return computed;
}

// Computes light on OpenGL, unless the textures have it. @return whether it was computed
bool ResidentLight::sweepOnGl(const LightMedium& medium, const TransferLookup& transfer, BrickSelection& bricks) {
  std::vector<std::int32_t> positions(bricks.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<std::int32_t>(i);
  bricks.require(positions);
  Swept next{medium, bricks.atlas().generation(), {}};
  for (const std::int32_t position : positions) next.slots.push_back(bricks.slotNumber(position));
  if (swept_ && *swept_ == next) return false;
  swept_.reset();  // whatever fails next
  const GlFunctions& gl = resident_.context().gl();
  textures_.clear(gl, bricks.atlas(), coloured_ ? 3 : 1);
  glSweep_.sweep(resident_, bricks, medium, transfer, textures_);
  gl.Finish();  // only a wait for the last voxel tells the time
  swept_ = std::move(next);
  return true;
}

void ResidentLight::addTo(RenderStats& stats) const {
  stats.directions = static_cast<int>(directions_);
  stats.lightOnGl = swept_.has_value();
  stats.lightNote = note_;
  stats.windowUpdates = swept_ ? glSweep_.updates() : light_.stats().updates;
  stats.lightSpacing = swept_ ? 1 : light_.stats().spacing;
  stats.lightSpacingError = swept_ ? 0 : light_.stats().spacingError;
  stats.windowBytes = textures_.bytes();
  stats.textureBytes += textures_.bytes();
  stats.bufferBytes += glSweep_.bytes();
  stats.lightMs = ms_;
}

void bindLight(const GlFunctions& gl, const ResidentLight& light, std::span<const int> textures) {
  for (std::size_t i = 0; i < textures.size(); ++i)
    gl.BindTextureUnit(i == 0 ? kLightUnit : kMoreLightUnit + static_cast<GLuint>(i) - 1, light.texture(textures[i]));
}

}  // namespace umbrick
