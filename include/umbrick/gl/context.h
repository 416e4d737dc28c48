// An OpenGL 4.5 core context without a window.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

namespace umbrick {

struct GlFunctions;

enum class Backend {
  automatic,  // OSMesa, or EGL where there is no OSMesa
  osmesa,     // software, in process
  egl,        // a GPU where there is one, else software; no display is needed
};

/// Made current on the thread that creates it, and used on that thread only. Of several, the one that was made current
/// last is used, and stays current when another one of its backend ends.
class GlContext {
 public:
  virtual ~GlContext();
  const GlFunctions& gl() const { return *functions_; }
  Backend backend() const { return backend_; }
  /// "OSMesa: llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 (Core Profile) Mesa 22.3.6"
  const std::string& description() const { return description_; }
  const std::string& renderer() const { return renderer_; }
  virtual void makeCurrent() = 0;

  /// Limits that size a volume's textures.
  int maxTextureEdge2d() const { return maxTextureEdge2d_; }
  int maxTextureEdge3d() const { return maxTextureEdge3d_; }

 protected:
  GlContext();
  /// Once the derived class has made its context current: loads the functions and reads what the driver says.
  void initialise(Backend backend, std::unique_ptr<GlFunctions> functions);

 private:
  std::unique_ptr<GlFunctions> functions_;
  Backend backend_ = Backend::automatic;
  std::string description_, renderer_;
  int maxTextureEdge2d_ = 0, maxTextureEdge3d_ = 0;
};

/// @throw GlError  no backend works: one line that says what was tried and why each failed
std::unique_ptr<GlContext> createGlContext(Backend backend = Backend::automatic);

/// "auto", "osmesa" or "egl". @throw InvalidArgument
Backend parseBackend(const std::string& name);

}  // namespace umbrick
