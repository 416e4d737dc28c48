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

  /// True when no lookup in the ranges, widened by one bin, can return sigma_t > 0, be it in these entries or in the
  /// means of preintegrate() over the same range with the same number of nodes. O(1).
  bool isTransparent(const Range& values, const Range& gradients = {0, 0}) const;

  /// (columns + 1) x (rows + 1) summed-area counts of the entries with sigma_t > 0 at them or within half a bin.
  std::vector<int> opaqueBefore;
};

/// Which values a table resolves.
enum class TableCover {
  varying,  // the part of the data range where the function varies: its resolution is not wasted on constant ends
  data,     // all of the data range: for preintegrate(), whose ramps cannot be cut off at the ends of the table
};

/// The function at the nodes of a table. What it does between two nodes is lost: a peak narrower than a bin is cut off
/// or missed, a step becomes a ramp one bin wide. preintegrate() keeps both.
/// @param value     the values that occur (data range)
/// @param gradient  the gradient magnitudes that occur; of no matter for a 1D function
/// @throw InvalidArgument  columns < 2, rows < 1 (or < 2 for a 2D function), an empty range
TransferTable sampleTransferFunction(const TransferFunction& transfer, const Range& value, const Range& gradient,
                                     int columns, int rows = 1, TableCover cover = TableCover::varying);

/// Means of the 1D function over every interval of values: entry (i, j) is the mean of (sigma_s, sigma_t) over values
/// from node i to node j, where the value runs linearly, computed from the exact integral of the piecewise function.
/// Lookup by (front value, back value) of a slab gives what a ramp of values between them scatters and absorbs per
/// length, for any slab length (Engel, Kraus, Ertl 2001, doi:10.1145/383507.383515). On the diagonal it is the
/// function, at a step the average of both sides.
///
/// With a thickness, sigma_s also accounts for the order of the media: a slab of that thickness with the entry as its
/// constant medium sends exactly the light to the eye that the ramp does, what is behind dimmed by what is in front; at
/// other thicknesses nearly so. Then the table is not symmetric, but for sigma_t.
///
/// A ramp must not leave `value`: a lookup would clamp its ends and so average over a part of it (air at 0, bone at
/// 2000 and a table from 500 to 1200 give a slab between them the mean over 500 to 1200). Use TableCover::data.
/// @param thickness  of the slab, world units; 0: means
/// @return nodes x nodes, front value fastest, over `value` of a TransferTable with nodes = columns
/// @throw InvalidArgument  a 2D function, nodes < 2, a range without extent
std::vector<glm::vec4> preintegrate(const TransferFunction& transfer, const Range& value, int nodes,
                                    double thickness = 0);

}  // namespace umbrick
