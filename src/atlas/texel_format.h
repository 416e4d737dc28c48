// How voxels are stored in texels of one or two channels (value; value and gradient magnitude).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/functions.h"

namespace umbrick {

struct TexelFormat {
  GLenum internal;    // e.g. GL_R16
  GLenum layout;      // GL_RED or GL_RG
  GLenum type;        // of a component
  std::size_t bytes;  // of a texel
};

TexelFormat texelFormat(VoxelFormat format, bool gradients);

}  // namespace umbrick
