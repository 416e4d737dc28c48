// How voxels are stored in texels of one to three channels: value, gradient magnitude, value of a second grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/functions.h"

namespace umbrick {

struct TexelFormat {
  GLenum internal;    // such as GL_R16
  GLenum layout;      // GL_RED, GL_RG or GL_RGB
  GLenum type;        // of one component
  std::size_t bytes;  // of one texel
};

TexelFormat texelFormat(VoxelFormat format, const Bricks& volume);

}  // namespace umbrick
