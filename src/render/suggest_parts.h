// Parts of suggestTransfer(), one for each kind of volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>

#include "umbrick/grid/value_survey.h"
#include "umbrick/render/suggest_transfer.h"

namespace umbrick {

/// What is known of a volume while a transfer function is made for it.
struct SuggestInput {
  const Volume& volume;
  ValueSurvey values;
  double diagonal = 0;   // of the box of the active voxels, world units
  double voxelEdge = 0;  // the shortest one, world units
  int axis = 1;          // of index space along which the viewer looks, more or less

  /// Extinction of what should look solid, 1/world unit: opaque within a pixel or two of a picture of some 256 pixels,
  /// but no denser than a voxel can show without steps.
  double solid() const;
  /// Extinction at which columns through values of the given weight have this optical depth, in the mean over columns
  /// that meet any of them. 1/world unit.
  double depthOf(double opticalDepth, const std::function<double(double)>& weight) const;
};

/// Tells whether a name has one of some words in it, of lower case letters.
bool namesOneOf(const std::string& name, std::initializer_list<const char*> words);

TransferFunction suggestLevelSet(const SuggestInput& input);
/// @param air  the value of air and of water less 1000: -1000 for HU
TransferFunction suggestCt(const SuggestInput& input, double air);
std::optional<TransferFunction> suggestLabels(const SuggestInput& input);
/// Returns nothing where the values are those of a field and not of regions.
std::optional<TransferFunction> suggestMaterials(const SuggestInput& input);
TransferFunction suggestDensity(const SuggestInput& input, bool coloured);
TransferFunction suggestHeat(const SuggestInput& input);
TransferFunction suggestSigned(const SuggestInput& input, double middle);

}  // namespace umbrick
