// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/objects.h"

#include <string>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"

namespace umbrick {
namespace {

std::string hex(GLenum value) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[(value >> shift) & 15];
  return text;
}

void checkStorage(const GlFunctions& gl, GLenum format, int width, int height, int depth) {
  const GLenum error = gl.GetError();
  if (error == GL_NO_ERROR) return;
  if (error == GL_OUT_OF_MEMORY)
    throw outOfMemory("OpenGL: a texture of " + std::to_string(width) + " x " + std::to_string(height) + " x " +
                      std::to_string(depth) + " texels of format " + hex(format));
  throw GlError("no texture of " + std::to_string(width) + " x " + std::to_string(height) + " x " +
                std::to_string(depth) + " texels of format " + hex(format) + ": error " + hex(error));
}

double texelBytes(GLenum format) {
  switch (format) {
    case GL_R8:
      return 1;
    case GL_R16:
    case GL_R16F:
    case GL_RG8:
      return 2;
    case GL_R32F:
    case GL_R32UI:
    case GL_RG16:
    case GL_RG16F:
    case GL_RGBA8:
    case GL_DEPTH24_STENCIL8:
      return 4;
    case GL_RG32F:
    case GL_RGBA16:
    case GL_RGBA16F:
    case GL_RGBA16UI:
      return 8;
    default:
      return 16;
  }
}

// Textures of software OpenGL lie in the program's memory, and Mesa does not always survive that it is refused some.
void checkMemory(const GlFunctions& gl, GLenum format, int width, int height, int depth) {
  constexpr double kLooked = 16 << 20;  // to ask the system takes longer than to make a small one
  const double bytes = texelBytes(format) * width * height * depth;
  if (bytes < kLooked) return;
  const GLubyte* const name = gl.GetString(GL_RENDERER);
  const std::string renderer = name ? reinterpret_cast<const char*>(name) : "";
  if (renderer.find("llvmpipe") == renderer.npos && renderer.find("softpipe") == renderer.npos) return;
  requireMemory("OpenGL: a texture of " + std::to_string(width) + " x " + std::to_string(height) + " x " +
                    std::to_string(depth) + " texels",
                bytes);
}

void setSampling(const GlFunctions& gl, GLuint texture, GLenum filter) {
  gl.TextureParameteri(texture, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  gl.TextureParameteri(texture, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TextureParameteri(texture, axis, GL_CLAMP_TO_EDGE);
}

}  // namespace

GLuint GlTextureKind::create(const GlFunctions& gl, GLenum target) {
  GLuint name = 0;
  gl.CreateTextures(target, 1, &name);
  return name;
}
void GlTextureKind::destroy(const GlFunctions& gl, GLuint name) { gl.DeleteTextures(1, &name); }

GLuint GlBufferKind::create(const GlFunctions& gl) {
  GLuint name = 0;
  gl.CreateBuffers(1, &name);
  return name;
}
void GlBufferKind::destroy(const GlFunctions& gl, GLuint name) { gl.DeleteBuffers(1, &name); }

GLuint GlVertexArrayKind::create(const GlFunctions& gl) {
  GLuint name = 0;
  gl.CreateVertexArrays(1, &name);
  return name;
}
void GlVertexArrayKind::destroy(const GlFunctions& gl, GLuint name) { gl.DeleteVertexArrays(1, &name); }

GLuint GlFramebufferKind::create(const GlFunctions& gl) {
  GLuint name = 0;
  gl.CreateFramebuffers(1, &name);
  return name;
}
void GlFramebufferKind::destroy(const GlFunctions& gl, GLuint name) { gl.DeleteFramebuffers(1, &name); }

GLuint GlQueryKind::create(const GlFunctions& gl, GLenum target) {
  GLuint name = 0;
  gl.CreateQueries(target, 1, &name);
  return name;
}
void GlQueryKind::destroy(const GlFunctions& gl, GLuint name) { gl.DeleteQueries(1, &name); }

GlTexture makeTexture2d(const GlFunctions& gl, GLenum format, int width, int height, GLenum filter) {
  GlTexture texture(gl, static_cast<GLenum>(GL_TEXTURE_2D));
  checkMemory(gl, format, width, height, 1);
  gl.TextureStorage2D(texture.name(), 1, format, width, height);
  checkStorage(gl, format, width, height, 1);
  setSampling(gl, texture.name(), filter);
  return texture;
}

GlTexture makeTextureArray(const GlFunctions& gl, GLenum format, int width, int height, int layers, GLenum filter) {
  GlTexture texture(gl, static_cast<GLenum>(GL_TEXTURE_2D_ARRAY));
  checkMemory(gl, format, width, height, layers);
  gl.TextureStorage3D(texture.name(), 1, format, width, height, layers);
  checkStorage(gl, format, width, height, layers);
  setSampling(gl, texture.name(), filter);
  return texture;
}

GlTexture makeTexture3d(const GlFunctions& gl, GLenum format, int width, int height, int depth) {
  GlTexture texture(gl, static_cast<GLenum>(GL_TEXTURE_3D));
  checkMemory(gl, format, width, height, depth);
  gl.TextureStorage3D(texture.name(), 1, format, width, height, depth);
  checkStorage(gl, format, width, height, depth);
  setSampling(gl, texture.name(), GL_LINEAR);
  return texture;
}

GlFramebuffer makeFramebuffer(const GlFunctions& gl, std::initializer_list<GLuint> colours, GLuint depthStencil) {
  GlFramebuffer framebuffer(gl);
  std::vector<GLenum> buffers;
  for (const GLuint colour : colours) {
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
    gl.NamedFramebufferTexture(framebuffer.name(), buffers.back(), colour, 0);
  }
  if (buffers.empty()) buffers.push_back(GL_NONE);
  gl.NamedFramebufferDrawBuffers(framebuffer.name(), static_cast<GLsizei>(buffers.size()), buffers.data());
  if (depthStencil) gl.NamedFramebufferTexture(framebuffer.name(), GL_DEPTH_STENCIL_ATTACHMENT, depthStencil, 0);
  const GLenum status = gl.CheckNamedFramebufferStatus(framebuffer.name(), GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw GlError("the driver refuses a render target with " + std::to_string(colours.size()) +
                  " colour buffers: status " + hex(status));
  return framebuffer;
}

void checkGl(const GlFunctions& gl, const char* where) {
  const GLenum error = gl.GetError();
  if (error != GL_NO_ERROR)
    throw GlError(std::string(where) +
                  (error == GL_OUT_OF_MEMORY ? ": out of graphics memory" : ": OpenGL error " + hex(error)));
}

void resetGlState(const GlFunctions& gl) {
  for (const GLenum capability :
       {GL_CULL_FACE, GL_RASTERIZER_DISCARD, GL_POLYGON_OFFSET_FILL, GL_COLOR_LOGIC_OP, GL_FRAMEBUFFER_SRGB,
        GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_PRIMITIVE_RESTART, GL_DEPTH_CLAMP})
    gl.Disable(capability);
  for (GLenum plane = 0; plane < 8; ++plane) gl.Disable(GL_CLIP_DISTANCE0 + plane);
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl.BlendEquation(GL_FUNC_ADD);
  for (const GLenum store : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS,
                             GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES, GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT,
                             GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_IMAGES, GL_PACK_SWAP_BYTES})
    gl.PixelStorei(store, 0);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  constexpr GLuint kUnits = 16;  // as many as any pass uses, and more
  for (GLuint unit = 0; unit < kUnits; ++unit) gl.BindSampler(unit, 0);
}

}  // namespace umbrick
