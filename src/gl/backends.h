// The two ways to a context; each throws GlError with the reason when it does not work here.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "umbrick/gl/context.h"

namespace umbrick {

std::unique_ptr<GlContext> createOsmesaContext();
std::unique_ptr<GlContext> createEglContext();

}  // namespace umbrick
