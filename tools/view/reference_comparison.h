// Compares what is drawn with the reference, in a thread of its own, while the picture goes on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "view/latest_job.h"
#include "view/view_renderer.h"

namespace umbrick::view {

/// Pixels along the longer edge of the pictures that are compared.
inline constexpr int kComparedEdge = 160;

/// Returns the scene at the size of a comparison; a smaller scene keeps its size.
ResolvedScene comparedScene(const ResolvedScene& scene);

/// Returns about how much memory the reference takes for a scene beside the volume, in bytes, at most: it copies the
/// blocks of voxels that are visible.
std::uint64_t referenceMemory(const Volume& volume, const ResolvedScene& scene);

/// Returns what a page shows of two pictures of one size: {"state": "done", "size", "text", "measures": [{"title",
/// "help", "value"}], "top", "pictures": {"drawn", "reference", "difference"}}. Pictures are PNG in base 64. The
/// difference is that of the channel that differs most, from black (0) to light yellow (`top`, a round number).
nlohmann::ordered_json comparisonOf(const Image& drawn, const Image& reference);

class ReferenceComparison {
 public:
  /// @param tell  is called by the thread that compares, with the number that start() returned, and with
  ///   {"state": "running", "share", "size"}, at last with what comparisonOf() returns or {"state": "none", "text"}
  explicit ReferenceComparison(std::function<void(std::uint64_t, const nlohmann::ordered_json&)> tell);

  /// Begins a comparison; one that is on its way is given up first, so that there is never more than one in memory.
  /// @param renderer  draws the other picture; outlives this
  /// @return the number of this comparison
  /// @throw InvalidArgument  the reference would take more memory than the scene allows for bricks
  std::uint64_t start(std::shared_ptr<const Volume> volume, const ResolvedScene& scene, ViewRenderer& renderer);
  /// Gives up what is compared, and does not wait for it.
  void drop() { job_.drop(); }
  /// Returns whether a comparison was neither dropped nor followed by another one.
  bool isCurrent(std::uint64_t number) const { return job_.isCurrent(number); }

 private:
  struct Compared;
  void compare(const Compared& compared, std::uint64_t number);

  std::function<void(std::uint64_t, const nlohmann::ordered_json&)> tell_;
  LatestJob job_;  // last: it uses all of the above
};

}  // namespace umbrick::view
