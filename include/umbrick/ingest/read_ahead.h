// Volumes read one after the other in a thread of their own, while those before are used.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens and reads volumes in order, slab by slab of about two million voxels. The next volume is begun when the last
/// slab of the one before has been read, whether that has been used or not. What waits to be used takes at most
/// `maxBytes`, or one slab where that is larger.
class ReadAhead {
 public:
  using Open = std::function<std::unique_ptr<VoxelSource>()>;

  /// @param volumes  each is called in the thread, and what it returns ends there as soon as it is read
  explicit ReadAhead(std::vector<Open> volumes, std::int64_t maxBytes = std::int64_t(1) << 28);
  /// Ends the thread, when the slab at hand has been read.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Waits until the next volume is open. It gives the same slabs as that would, and throws the same errors where they
  /// were met. What is left of the one before is dropped.
  /// @return a source that must not outlive this  @throw Error  as the volume does when it is opened
  /// @pre there are more volumes
  std::unique_ptr<VoxelSource> next();

  struct Queue;  // of what has been read

 private:
  std::unique_ptr<Queue> queue_;
};

}  // namespace umbrick
