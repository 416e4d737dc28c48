// A transfer function sampled for lookup by the renderer: RGBA = sigma_s (associated linear RGB), sigma_t.
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "umbrick/core/range.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// Entries at the ends of equal bins over `value` (and `gradient`): entry i stands at value.min + i extent / (columns -
/// 1); linear between entries, constant beyond the ends.
struct TransferTable {
  Range value, gradient;
  int columns = 0;                 // along value
  int rows = 1;                    // along gradient magnitude; 1 for a 1D function
  std::vector<glm::vec4> entries;  // columns x rows, value fastest; sigma_s rgb, sigma_t; 1/world unit

  /// True when no lookup in the ranges, widened by one bin, can return sigma_t > 0. O(1) per row-range: uses prefix
  /// counts.
  bool isTransparent(const Range& values, const Range& gradients = {0, 0}) const;

  std::vector<int> opaqueBefore;  // (columns + 1) x (rows + 1) summed-area counts of entries with sigma_t > 0
};

/// @param value     the values that occur (data range); the table covers its intersection with where the function
/// varies,
///                  at least one bin, so that resolution is not wasted on constant ends
/// @throw InvalidArgument  columns < 2, rows < 1 (or < 2 for a 2D function)
TransferTable sampleTransferFunction(const TransferFunction& transfer, const Range& value, const Range& gradient,
                                     int columns, int rows = 1);

/// Means of the 1D function over every interval of values: entry (i, j) is the mean of (sigma_s, sigma_t) over values
/// from node i to node j, where the value runs linearly, computed from the exact integral of the piecewise function.
/// Lookup by (front value, back value) of a slab gives what a ramp of values between them scatters and absorbs per
/// length, for any slab length (Engel, Kraus, Ertl 2001, doi:10.1145/383507.383515, without the attenuation inside the
/// slab).
/// @return nodes x nodes, front value fastest, over table.value
/// @throw InvalidArgument  a 2D function, nodes < 2
std::vector<glm::vec4> preintegrate(const TransferFunction& transfer, const Range& value, int nodes);

}  // namespace umbrick
