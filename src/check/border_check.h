// Checks whether what lies at the border of a volume is drawn as whole as what lies inside of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "check/steps.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/check/invariants.h"

namespace umbrick {

/// Cuts pieces out of the volume, so that what it holds ends at their faces, with their last voxel at every
/// residue of 8. Each piece is rendered in slabs as wide as every quality has them: as it is, and with empty space
/// around it, which must make no difference. Nothing is measured where the background is visible, since it then
/// ends somewhere else.
/// @param cut  makes bricks
void checkBorder(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                 const std::function<std::unique_ptr<Bricks>(const ScalarGrid&, const BrickOptions&)>& cut,
                 const CheckSteps& steps, InvariantResult& result);

}  // namespace umbrick
