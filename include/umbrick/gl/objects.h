// Owners of OpenGL objects: made in the constructor, deleted in the destructor, moved but never copied.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <initializer_list>
#include <utility>

#include "umbrick/gl/functions.h"

namespace umbrick {

/// Owns the name of one object, which `Kind` makes and deletes. The context must be current for both.
template <class Kind>
class GlObject {
 public:
  GlObject() = default;
  template <class... Arguments>
  explicit GlObject(const GlFunctions& gl, Arguments... arguments) : gl_(&gl), name_(Kind::create(gl, arguments...)) {}
  ~GlObject() {
    if (gl_) Kind::destroy(*gl_, name_);
  }
  GlObject(GlObject&& other) noexcept : gl_(std::exchange(other.gl_, nullptr)), name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return gl_ != nullptr; }

 private:
  const GlFunctions* gl_ = nullptr;
  GLuint name_ = 0;
};

struct GlTextureKind {
  static GLuint create(const GlFunctions& gl, GLenum target);
  static void destroy(const GlFunctions& gl, GLuint name);
};
struct GlBufferKind {
  static GLuint create(const GlFunctions& gl);
  static void destroy(const GlFunctions& gl, GLuint name);
};
struct GlVertexArrayKind {
  static GLuint create(const GlFunctions& gl);
  static void destroy(const GlFunctions& gl, GLuint name);
};
struct GlFramebufferKind {
  static GLuint create(const GlFunctions& gl);
  static void destroy(const GlFunctions& gl, GLuint name);
};
struct GlQueryKind {
  static GLuint create(const GlFunctions& gl, GLenum target);
  static void destroy(const GlFunctions& gl, GLuint name);
};

using GlTexture = GlObject<GlTextureKind>;
using GlBuffer = GlObject<GlBufferKind>;
using GlVertexArray = GlObject<GlVertexArrayKind>;
using GlFramebuffer = GlObject<GlFramebufferKind>;
using GlQuery = GlObject<GlQueryKind>;

/// Makes a 2D texture of one level with clamped edges. `filter` is GL_NEAREST or GL_LINEAR.
/// @throw GlError  the driver has no room for it; the message says size and format
GlTexture makeTexture2d(const GlFunctions& gl, GLenum format, int width, int height, GLenum filter);
/// Makes an array of 2D textures of this kind. @throw GlError  as makeTexture2d
GlTexture makeTextureArray(const GlFunctions& gl, GLenum format, int width, int height, int layers, GLenum filter);
/// Makes a 3D texture of one level with clamped edges and linear filter. @throw GlError  as makeTexture2d
GlTexture makeTexture3d(const GlFunctions& gl, GLenum format, int width, int height, int depth);

/// Makes a framebuffer that draws into `colours` (attachments 0, 1, ...) and into a depth-stencil texture if
/// that is not 0.
/// @throw GlError  the driver refuses the combination
GlFramebuffer makeFramebuffer(const GlFunctions& gl, std::initializer_list<GLuint> colours, GLuint depthStencil = 0);

/// Sets the state that no pass sets since a context of ours has it from the beginning, but that a foreign context may
/// have changed: culling of faces, polygon mode, blend equation, pixel storage, bound buffers of pixels, samplers.
void resetGlState(const GlFunctions& gl);

/// @throw GlError  an OpenGL error is pending; the message names it and `where`
void checkGl(const GlFunctions& gl, const char* where);

}  // namespace umbrick
