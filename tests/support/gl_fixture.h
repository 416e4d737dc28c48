// The context that tests of OpenGL rooms share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iostream>
#include <memory>

#include "umbrick/core/error.h"
#include "umbrick/gl/context.h"

namespace umbrick {

/// A context, or null after saying why there is none; then the test returns:
///   const auto context = testContext();
///   if (!context) return;
inline std::unique_ptr<GlContext> testContext(Backend backend = Backend::automatic) {
  try {
    return createGlContext(backend);
  } catch (const GlError& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return nullptr;
  }
}

}  // namespace umbrick
