// SPDX-License-Identifier: Apache-2.0
#include "atlas/texel_format.h"

#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/core/error.h"

namespace umbrick {

TexelFormat texelFormat(VoxelFormat format, const Bricks& volume) {
  // A second grid has the third channel, also where there are no gradients, which are 0 then.
  if (volume.hasEmission) return {GL_RGB32F, GL_RGB, GL_FLOAT, 3 * sizeof(float)};
  const bool gradients = volume.hasGradients;
  const GLenum layout = gradients ? GL_RG : GL_RED;
  const std::size_t channels = gradients ? 2 : 1;
  switch (format) {
    case VoxelFormat::unorm8:
      return {gradients ? GLenum{GL_RG8} : GLenum{GL_R8}, layout, GL_UNSIGNED_BYTE, channels};
    case VoxelFormat::unorm16:
      return {gradients ? GLenum{GL_RG16} : GLenum{GL_R16}, layout, GL_UNSIGNED_SHORT, 2 * channels};
    case VoxelFormat::half:
      return {gradients ? GLenum{GL_RG16F} : GLenum{GL_R16F}, layout, GL_HALF_FLOAT, 2 * channels};
    case VoxelFormat::float32:
      break;
  }
  return {gradients ? GLenum{GL_RG32F} : GLenum{GL_R32F}, layout, GL_FLOAT, 4 * channels};
}

VoxelFormat parseVoxelFormat(const std::string& name, const Bricks& volume) {
  if (name == "auto") {
    // Gradient magnitudes are not whole numbers, nor are temperatures, so no smaller format holds them exactly.
    if (volume.hasGradients || volume.hasEmission) return VoxelFormat::float32;
    // Software and hardware alike filter 8-bit texels with 8-bit weights, which keeps voxels exact but makes
    // steps between them.
    return volume.exactFormat == VoxelFormat::unorm8 ? VoxelFormat::unorm16 : volume.exactFormat;
  }
  for (const VoxelFormat format : {VoxelFormat::unorm8, VoxelFormat::unorm16, VoxelFormat::half, VoxelFormat::float32})
    if (name == voxelFormatName(format)) {
      if (volume.hasEmission && format != VoxelFormat::float32)
        throw InvalidArgument("format: " + name + " does not hold the values of a grid that emits light; use float32");
      if (volume.hasGradients && (format == VoxelFormat::unorm8 || format == VoxelFormat::unorm16))
        throw InvalidArgument("format: " + name +
                              " cannot hold gradient magnitudes of a 2D transfer function; use half or float32");
      if (volume.hasGradients && format == VoxelFormat::half && volume.gradient.max > 65504)
        throw InvalidArgument("format: half holds gradient magnitudes up to 65504, those of the volume reach " +
                              std::to_string(volume.gradient.max) + "; use float32");
      return format;
    }
  throw InvalidArgument("format: '" + name + "' is not one of auto, unorm8, unorm16, half, float32");
}

std::string voxelFormatName(VoxelFormat format) {
  switch (format) {
    case VoxelFormat::unorm8:
      return "unorm8";
    case VoxelFormat::unorm16:
      return "unorm16";
    case VoxelFormat::half:
      return "half";
    case VoxelFormat::float32:
      break;
  }
  return "float32";
}

}  // namespace umbrick
