// SPDX-License-Identifier: Apache-2.0
#include "gl/shared_library.h"

#include <dlfcn.h>

#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names) {
  std::string reasons;
  for (const char* name : names) {
    handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle_) return;
    const char* reason = dlerror();
    if (reasons.empty()) reasons = reason ? reason : name;
  }
  throw GlError(reasons);
}

GlProcedure SharedLibrary::procedure(const char* name) const {
  void* address = dlsym(handle_, name);
  if (!address) throw GlError(std::string("no function ") + name);
  return reinterpret_cast<GlProcedure>(address);
}

}  // namespace umbrick
