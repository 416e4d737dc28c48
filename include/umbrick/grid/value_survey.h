// Statistics of a grid's values, from which one can choose how to show them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "umbrick/core/range.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// What the finite active values of a grid are. Voxels of active tiles count like others.
struct ValueSurvey {
  std::uint64_t voxels = 0;     // finite and active
  std::uint64_t boxVoxels = 0;  // of the box around the active ones
  double background = 0;        // grid units
  Range value;                  // the smallest and the largest one; empty where there is none
  double low = 0, high = 0;  // grid units, low < high; about one in two thousand values lies below, and as many above
  std::vector<double>
      histogram;  // voxels in bins of equal width from low to high; what lies beyond is in the outer bins
  /// For each bin the mean of |gradient| of its voxels, grid units per voxel, by central differences. It is small for
  /// values of which there are whole regions, and large for those that are only met on the way from one to another.
  std::vector<double> gradient;
  bool wholeNumbers = false;  // all values are
  /// All values that occur, with the number of their voxels, ascending; empty where they are no whole numbers or more
  /// than kMostDistinct.
  std::vector<std::pair<double, std::uint64_t>> distinct;
  /// The share of pairs of neighbours of different value between which another of the distinct values lies. In an image
  /// that few values were left of neighbours are mostly next in value; labels lie beside each other in any order.
  double jumps = 0;

  double binWidth() const { return (high - low) / static_cast<double>(histogram.size()); }
  double binCentre(std::size_t bin) const { return low + (static_cast<double>(bin) + 0.5) * binWidth(); }
};

inline constexpr int kSurveyBins = 256;
inline constexpr int kMostDistinct = 64;

/// Looks at all active values, by all cores. Gradients are those of voxels whose neighbours lie in the same leaf: 42 %
/// of all voxels, spread evenly.
ValueSurvey surveyValues(const ScalarGrid& grid);

/// Returns the largest gradient magnitude of active voxels, by central differences with the neighbours that are finite;
/// grid units per world unit.
double largestGradient(const ScalarGrid& grid);

/// Integrates a function of the value along columns of voxels, for an idea of the optical depth of what is shown.
/// @param axis    of the grid's index space along which columns run: 0, 1 or 2
/// @param weight  of a value, >= 0; is called by several threads
/// @return for each column with a sum above 0 the sum times the length of a voxel along it, world units. Of large
///   grids neighbouring columns are averaged until there are at most 512 x 512.
std::vector<double> columnIntegrals(const ScalarGrid& grid, int axis, const std::function<double(double)>& weight);

/// Returns the box in index space around the active voxels that a test accepts, tiles included; empty where it accepts
/// none. @param accepts  is called by several threads
IndexBox acceptedBox(const ScalarGrid& grid, const std::function<bool(double)>& accepts);

}  // namespace umbrick
