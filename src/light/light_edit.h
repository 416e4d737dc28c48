// What an edit of the medium or of the light changes, so that only that is swept again.
//
//   light      \    \    \           Paths that miss the changed bricks are as before. Of the others the old medium's
//       +-------\----\----\---+      light is taken away and the new one's is added, from the first changed slice on:
//       |        \    \    \  |      upstream both are the same, and paths are followed there without lighting voxels.
//       |        [changed]  \ |
//       |          \    \    \|      Light is summed in whole numbers, so that what was added is taken away to the last
//       +-----------\----\----+      bit.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "light/light_sweep.h"
#include "umbrick/light/light_volume.h"

namespace umbrick {

/// Tells whether two functions have the same sigma_t for all values of a brick.
bool sameExtinction(const TransferFunction& a, const TransferFunction& b, const Brick& brick);

/// Returns the bricks around which the medium of one differs from that of the other, in ascending order.
/// @param bricks  the volume's; cells of both mediums are among them, or have no medium but background
std::vector<glm::ivec3> changedCells(const LightMedium& before, const LightMedium& after, const Bricks& bricks);

/// What is swept for an edit.
struct LightEdit {
  std::vector<SweepTask> tasks;    // with paths and first slices, of factor 1
  std::vector<glm::ivec3> bricks;  // the bricks that these paths meet, of both mediums; ascending
  double cost = 0;                 // as a share of that of sweeping all
};

/// @param all   what is swept for all of the medium
/// @param both  cells of both mediums, ascending
LightEdit editOf(const std::vector<SweepTask>& all, const std::vector<glm::ivec3>& changed,
                 const std::vector<glm::ivec3>& both, const BrickLayout& layout, int spacing);

/// How the light of one set of directions becomes that of another.
struct DirectionEdit {
  std::vector<LightDirection> change;  // radiance to be added
  glm::dvec3 scale{1};                 // of shares that stay, since the whole light is another one
};
/// @return none where as many directions change as there are, or where the whole light is 0
std::optional<DirectionEdit> editOf(const std::vector<LightDirection>& before, const glm::dvec3& wholeBefore,
                                    const std::vector<LightDirection>& after, const glm::dvec3& wholeAfter);

}  // namespace umbrick
