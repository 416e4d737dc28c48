// An OpenGL 4.5 core context without a window.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "umbrick/core/names.h"

namespace umbrick {

struct GlFunctions;
using GlProcedure = void (*)();

enum class Backend {
  automatic,  // OSMesa, or EGL where there is no OSMesa
  osmesa,     // software, in process
  egl,        // a GPU where there is one, else software; no display is needed
  foreign,    // made by somebody else, see adoptGlContext
};
/// What can be asked for.
inline constexpr Name<Backend> kBackends[]{
    {"auto", Backend::automatic}, {"osmesa", Backend::osmesa}, {"egl", Backend::egl}};

/// A context is made current on the thread that creates it, and is used on that thread only. Of several contexts the
/// one that was made current last is used. It stays current when another context of the same backend ends.
class GlContext {
 public:
  virtual ~GlContext();
  const GlFunctions& gl() const { return *functions_; }
  Backend backend() const { return backend_; }
  /// Returns a text such as "OSMesa: llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 (Core Profile) Mesa 22.3.6".
  const std::string& description() const { return description_; }
  const std::string& renderer() const { return renderer_; }
  /// Tells whether OpenGL draws on the CPU, as far as the name of the renderer shows.
  bool software() const { return software_; }
  virtual void makeCurrent() = 0;

  /// Returns the limits to the size of a volume's textures.
  int maxTextureEdge2d() const { return maxTextureEdge2d_; }
  int maxTextureEdge3d() const { return maxTextureEdge3d_; }

 protected:
  GlContext();
  /// Loads the functions and reads what the driver says. A derived class calls this once it has made its
  /// context current.
  void initialise(Backend backend, std::unique_ptr<GlFunctions> functions);

 private:
  std::unique_ptr<GlFunctions> functions_;
  Backend backend_ = Backend::automatic;
  std::string description_, renderer_;
  bool software_ = false;
  int maxTextureEdge2d_ = 0, maxTextureEdge3d_ = 0;
};

/// @throw InvalidArgument  Backend::foreign
/// @throw GlError  no backend works: one line that says what was tried and why each failed
std::unique_ptr<GlContext> createGlContext(Backend backend = Backend::automatic);

/// Tells whether EGL finds a GPU, without making a context on it.
bool hasGpu();

/// Uses a context that somebody else made, of a window or another library: OpenGL 4.5 core, current on this thread. It
/// is not destroyed with what this returns. Renderers set all state that they rely on and leave it as they need it: who
/// draws besides sets his own again.
/// @param procedure    gives the address of a function by its full name, as glfwGetProcAddress does, or null
/// @param makeCurrent  makes it current again; may be empty where nothing else ever is
/// @throw GlError  names the first function that is missing
std::unique_ptr<GlContext> adoptGlContext(const std::function<GlProcedure(const char*)>& procedure,
                                          std::function<void()> makeCurrent = {});

}  // namespace umbrick
