// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/functions.h"

#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

GlFunctions loadGlFunctions(const std::function<GlProcedure(const char*)>& procedure) {
  GlFunctions gl;
  const auto load = [&](const char* name) {
    const GlProcedure address = procedure(name);
    if (!address) throw GlError(std::string("the OpenGL driver has no ") + name + " (OpenGL 4.5 is needed)");
    return address;
  };
#define UMBRICK_GL_LOAD(TYPE, NAME) gl.NAME = reinterpret_cast<PFNGL##TYPE##PROC>(load("gl" #NAME));
  UMBRICK_GL_FUNCTIONS(UMBRICK_GL_LOAD)
#undef UMBRICK_GL_LOAD
  return gl;
}

}  // namespace umbrick
