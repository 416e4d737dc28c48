// Scenes lit by ordinates, and how far two pictures of them are apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "support/test_scenes.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

inline ResolvedScene ordinatesScene(const TransferFunction& transfer, const Camera& camera, double spacing,
                                    double theta, int directions) {
  ResolvedScene scene = plainScene(transfer, camera, spacing);
  scene.model = Model::cone;
  scene.method = Method::ordinates;
  scene.occlusion.aperture = theta;
  scene.occlusion.ordinates.directions = directions;
  return scene;
}

/// Returns the largest difference of colours and visibilities.
inline double layersDifference(const Picture& a, const Picture& b) {
  return std::max(maxDifference(a.colour, b.colour), maxDifference(a.visibility, b.visibility));
}

}  // namespace umbrick
