// SPDX-License-Identifier: Apache-2.0

// Before osmesa.h, whose older OpenGL header would hide the types of the newer functions.
#include "umbrick/gl/functions.h"

#include <GL/osmesa.h>

#include <vector>

#include "gl/backends.h"
#include "gl/shared_library.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

class OsmesaContext : public GlContext {
 public:
  OsmesaContext() : library_({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    const auto create = library_.function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              4,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              5,
                              0};
    context_ = create(attributes, nullptr);
    if (!context_) throw GlError("no OpenGL 4.5 core context");
    try {
      makeCurrent();
      const auto find = library_.function<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress");
      initialise(Backend::osmesa, std::make_unique<GlFunctions>(loadGlFunctions(
                                      [&](const char* name) { return reinterpret_cast<GlProcedure>(find(name)); })));
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~OsmesaContext() override { destroy(); }

  void makeCurrent() override {
    const auto make = library_.function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    if (!make(context_, pixels_.data(), GL_UNSIGNED_BYTE, kEdge, kEdge))
      throw GlError("cannot make the context current");
  }

 private:
  void destroy() { library_.function<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")(context_); }

  // OSMesa draws to memory of ours. All drawing here goes to framebuffer objects, so this memory is small and
  // never looked at.
  static constexpr int kEdge = 8;
  std::vector<unsigned char> pixels_ = std::vector<unsigned char>(4 * kEdge * kEdge);
  SharedLibrary library_;
  OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> createOsmesaContext() { return std::make_unique<OsmesaContext>(); }

}  // namespace umbrick
