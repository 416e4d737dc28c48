// Statistics of a picture that is made of several.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Adds what another picture took to the counts and times of one.
void addWork(RenderStats& sum, const RenderStats& other);

}  // namespace umbrick
