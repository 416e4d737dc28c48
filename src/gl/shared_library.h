// A library that is loaded when it is first needed, so that a machine without it can still run the rest.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>

#include "umbrick/gl/functions.h"

namespace umbrick {

class SharedLibrary {
 public:
  /// Loads the first of `names` that exists. It stays loaded until the process ends, since drivers leave threads and
  /// exit handlers behind that must not lose their code.
  /// @throw GlError  none could be loaded; the message is the loader's
  explicit SharedLibrary(std::initializer_list<const char*> names);
  /// @throw GlError  there is no such function
  GlProcedure procedure(const char* name) const;
  template <class Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(procedure(name));
  }

 private:
  void* handle_ = nullptr;
};

}  // namespace umbrick
