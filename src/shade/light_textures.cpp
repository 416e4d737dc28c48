// SPDX-License-Identifier: Apache-2.0
#include "shade/light_textures.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace umbrick {

void LightTextures::makeTextures(const GlFunctions& gl, const BrickAtlas& atlas, int channels) {
  if (atlas_ == &atlas && generation_ == atlas.generation() && channels_ == channels) return;
  textures_.clear();
  held_.assign(atlas.slots(), {});
  const glm::ivec3 size = atlas.textureSize();
  for (int i = 0; i < atlas.textureCount(); ++i)
    textures_.push_back(makeTexture3d(gl, channels == 3 ? GL_RGBA32F : GL_R32F, size.x, size.y, size.z));
  atlas_ = &atlas;
  generation_ = atlas.generation();
  channels_ = channels;
  bytes_ = static_cast<std::uint64_t>(atlas.textureCount()) * static_cast<std::uint64_t>(size.x) *
           static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(size.z) * (channels == 3 ? 16u : 4u);
}

void LightTextures::clear(const GlFunctions& gl, const BrickAtlas& atlas, int channels) {
  makeTextures(gl, atlas, channels);
  held_.assign(held_.size(), {});
  for (const GlTexture& texture : textures_)
    gl.ClearTexImage(texture.name(), 0, channels == 3 ? GL_RGBA : GL_RED, GL_FLOAT, nullptr);
  checkGl(gl, "textures of light");
}

void LightTextures::require(const GlFunctions& gl, const BrickSelection& bricks, const LightVolume& light,
                            std::uint64_t version, std::span<const std::int32_t> positions) {
  const BrickAtlas& atlas = bricks.atlas();
  makeTextures(gl, atlas, light.channels());
  std::vector<std::int32_t> missing;
  for (const std::int32_t position : positions) {
    Held& held = held_[static_cast<std::size_t>(bricks.slotNumber(position))];
    if (held == Held{position, version}) continue;
    held = {position, version};
    missing.push_back(position);
  }
  const glm::ivec3 edge = atlas.layout().edge();
  const std::size_t numbers = atlas.layout().voxels() * static_cast<std::size_t>(channels_);
  constexpr std::size_t kTogether = 64;
  std::vector<float> staging(std::min(kTogether, missing.size()) * numbers);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t first = 0; first < missing.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, missing.size() - first);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      light.read(bricks.origins()[static_cast<std::size_t>(missing[first + i])],
                 std::span(staging).subspan(i * numbers, numbers));
    });
    for (std::size_t i = 0; i < count; ++i) {
      const BrickAtlas::Slot slot = bricks.slot(missing[first + i]);
      gl.TextureSubImage3D(texture(slot.texture), 0, slot.origin.x, slot.origin.y, slot.origin.z, edge.x, edge.y,
                           edge.z, channels_ == 3 ? GL_RGB : GL_RED, GL_FLOAT, staging.data() + i * numbers);
    }
  }
  uploaded_ += missing.size();
  checkGl(gl, "upload of light");
}

}  // namespace umbrick
