// SPDX-License-Identifier: Apache-2.0
#include "shade/voxel_codes.h"

#include <cmath>

namespace umbrick {

VoxelCodes::VoxelCodes(const ResidentVolume& resident) : apron_(resident.volume().layout.apron) {
  const VoxelFormat format = resident.format();
  const Bricks& volume = resident.volume();
  const TexelScale scale = texelScale(volume, format);
  fixedPoint_ = format == VoxelFormat::unorm8 || format == VoxelFormat::unorm16;
  perTexel_ = format == VoxelFormat::unorm8 ? 255 : fixedPoint_ ? 65535 : 1;
  unit_ = scale.scale / perTexel_;
  offset_ = scale.offset;
  rounding_ = scale.rounding / unit_;
  storedEmpty_ = texelOf(volume.background, scale, format) * perTexel_;
  if (fixedPoint_) storedEmpty_ = std::round(storedEmpty_);
  empty_ = toCode(volume.background);
}

void VoxelCodes::setConstants(ShaderConstants& constants) const {
  constants["kFixedPoint"] = fixedPoint_;
  constants["kLossy"] = static_cast<float>(storedEmpty_) != static_cast<float>(empty_);
}

void VoxelCodes::setUniforms(GlProgram& program) const {
  program.set("code_scale", static_cast<float>(perTexel_));
  program.set("empty_code", glm::vec2(storedEmpty_, empty_));
  program.set("apron", apron_);
}

}  // namespace umbrick
