// A transfer function that suits a volume of which nobody has said how to show it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/optics/transfer_function.h"
#include "umbrick/render/volume.h"

namespace umbrick {

/// What a volume is taken for.
enum class VolumeKind {
  levelSet,    // distances to a surface: the surface
  ct,          // CT numbers: air away, tissue faint, bone solid
  labels,      // a colour a label
  materials,   // regions of one value each: the outer ones faint, the innermost solid
  density,     // fog: extinction in proportion to the value
  heat,        // temperature or flames: the same in the colours of glowing bodies
  signedField  // values on both sides of a middle: two colours, and nothing at the middle
};

struct SuggestedTransfer {
  TransferFunction transfer;
  VolumeKind kind = VolumeKind::materials;
  std::string reason;  // in words, for people: "CT in HU: air away, tissue faint, bone solid"
};

/// Chooses by the class, unit and name of the grid, and by the values of its active voxels and their gradients. sigma_t
/// follows from the size of what is shown and not from that of a voxel.
///
/// Where nothing else is known, values that whole regions have are told from those that are only met between regions by
/// their small gradients, as of Kindlmann and Durkin 1998 (doi:10.1145/288126.288167): a region's values are a minimum
/// of the mean gradient over value, and two regions part where it has its maximum.
SuggestedTransfer suggestTransfer(const Volume& volume);

/// Returns the unit of CT values: what the file states, or else kHounsfield or kShiftedHounsfield where the values are
/// distributed as those of a CT; empty for anything else.
std::string ctUnit(const Volume& volume);

/// Returns a transfer function with the unit of the volume, see inUnit(). Only a function that is made for CT looks at
/// the volume at all.
TransferFunction fitted(const TransferFunction& transfer, const Volume& volume);

}  // namespace umbrick
