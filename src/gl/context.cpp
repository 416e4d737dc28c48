// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/context.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "gl/backends.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/gl/functions.h"

namespace umbrick {
namespace {

// Mesa ends the program where it is refused memory in some places, so it is not begun with less than its libraries, its
// compiler and its threads map.
constexpr double kContextAddresses = 450.0 * (1 << 20), kContextBytes = 100.0 * (1 << 20);

bool isSoftware(std::string renderer) {
  std::ranges::transform(renderer, renderer.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 5> names{"llvmpipe", "softpipe", "swrast", "swiftshader", "software"};
  return std::ranges::any_of(names, [&](std::string_view name) { return renderer.find(name) != std::string::npos; });
}

}  // namespace

GlContext::GlContext() = default;
GlContext::~GlContext() = default;

void GlContext::initialise(Backend backend, std::unique_ptr<GlFunctions> functions) {
  functions_ = std::move(functions);
  backend_ = backend;
  const auto text = [&](GLenum name) {
    const GLubyte* bytes = gl().GetString(name);
    return std::string(bytes ? reinterpret_cast<const char*>(bytes) : "unknown");
  };
  renderer_ = text(GL_RENDERER);
  software_ = isSoftware(renderer_);
  description_ = std::string(backend == Backend::osmesa ? "OSMesa: "
                             : backend == Backend::egl  ? "EGL: "
                                                        : "") +
                 renderer_ + ", OpenGL " + text(GL_VERSION);
  gl().GetIntegerv(GL_MAX_TEXTURE_SIZE, &maxTextureEdge2d_);
  gl().GetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &maxTextureEdge3d_);
}

std::unique_ptr<GlContext> createGlContext(Backend backend) {
  if (backend == Backend::foreign) throw InvalidArgument("backend: a foreign context is adopted, not created");
  requireAddressSpace("OpenGL: a context with its compiler", kContextAddresses);
  requireMemory("OpenGL: a context with its compiler", kContextBytes);
  std::string reasons;
  const auto attempt = [&](const char* name, auto create) -> std::unique_ptr<GlContext> {
    try {
      return create();
    } catch (const GlError& error) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(name) + " (" + error.what() + ")";
      return nullptr;
    }
  };
  if (backend != Backend::egl)
    if (auto context = attempt("OSMesa", createOsmesaContext)) return context;
  if (backend != Backend::osmesa)
    if (auto context = attempt("EGL", createEglContext)) return context;
  throw GlError("no OpenGL context: tried " + reasons);
}

namespace {

class ForeignContext : public GlContext {
 public:
  ForeignContext(const std::function<GlProcedure(const char*)>& procedure, std::function<void()> makeCurrent)
      : makeCurrent_(std::move(makeCurrent)) {
    initialise(Backend::foreign, std::make_unique<GlFunctions>(loadGlFunctions(procedure)));
  }
  void makeCurrent() override {
    if (makeCurrent_) makeCurrent_();
  }

 private:
  std::function<void()> makeCurrent_;
};

}  // namespace

std::unique_ptr<GlContext> adoptGlContext(const std::function<GlProcedure(const char*)>& procedure,
                                          std::function<void()> makeCurrent) {
  return std::make_unique<ForeignContext>(procedure, std::move(makeCurrent));
}

}  // namespace umbrick
