// Which labels become grids, and what the grids are called.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "umbrick/grid/label_grids.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

using LabelKey = std::pair<std::int64_t, std::int64_t>;  // component, value

class WantedLabels {
 public:
  /// @throw InvalidArgument  a label that is neither a value nor one of the file's names
  WantedLabels(const VolumeInfo& info, const LabelChoice& choice);
  bool contains(const LabelKey& key) const { return all_ || keys_.contains(key) || values_.contains(key.second); }
  /// Puts the grids in order, gives each a name of its own and says what the file names without a voxel.
  /// @throw InvalidArgument  a label that was named by its value or name has no voxel
  LabelGrids collect(const VolumeInfo& info, std::map<LabelKey, LabelGrid> found) const;

 private:
  void checkFound(const VolumeInfo& info, const std::map<LabelKey, LabelGrid>& found) const;

  bool all_;
  std::set<LabelKey> keys_;
  std::set<std::int64_t> values_;
};

/// The grid of a label, which is made when it is first asked for. @throw InvalidArgument  there are too many
LabelGrid& labelGrid(const VolumeInfo& info, const LabelKey& key, std::map<LabelKey, LabelGrid>& found);

/// The places of labels in their list.
std::map<LabelKey, std::size_t> placesOf(const std::vector<VolumeLabel>& labels);

std::uint64_t voxelsIn(const VolumeInfo& info);

}  // namespace umbrick
