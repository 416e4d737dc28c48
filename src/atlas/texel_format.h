// How voxels are stored in texels of one or two channels (value; value and gradient magnitude).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/functions.h"

namespace umbrick {

struct TexelFormat {
  GLenum internal;    // such as GL_R16
  GLenum layout;      // GL_RED or GL_RG
  GLenum type;        // of one component
  std::size_t bytes;  // of one texel
};

TexelFormat texelFormat(VoxelFormat format, bool gradients);

}  // namespace umbrick
