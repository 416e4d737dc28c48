// Pixels of the mode hybrid: the first surface, and the medium behind it, in double precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "reference/quadrature.h"
#include "reference/value_pixel.h"

namespace umbrick {

/// Renders pixels, whose colour, depth and visibility are those of both. Each thread has one of its own.
class HybridPixel {
 public:
  /// @param surfaces  of the scene; medium: of the medium behind them, whose scene has the mode integrate
  /// @param step      see QuadraturePixel
  HybridPixel(const ValueSpace& surfaces, const ReferenceSpace& medium, const ReferenceOptions& options, double step,
              double voxelEdge, const GoOn& goOn);
  std::optional<ValueResult> integrate(int x, int y);
  RayCounts counts() const;

 private:
  const ReferenceSpace& space_;
  ValuePixel surface_;
  QuadraturePixel medium_;
};

}  // namespace umbrick
