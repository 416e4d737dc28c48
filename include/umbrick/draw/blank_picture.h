// The picture of a volume that holds nothing, as frames of a sequence may.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Returns the scene's background, or transparent pixels where it has none. @param layers  the layers of Picture, too
Picture blankPicture(const ResolvedScene& scene, bool layers);

}  // namespace umbrick
