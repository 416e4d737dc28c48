// Volumes that a thread reads one after the other, while the caller still uses those before.
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

  /// @param volumes  opens one volume each; it is called in the thread, which drops the volume once it is read
  explicit ReadAhead(std::vector<Open> volumes, std::int64_t maxBytes = std::int64_t(1) << 28);
  /// Waits until the slab at hand has been read, and ends the thread.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Waits until the next volume is open. The source that is returned gives the same slabs as that volume would, and
  /// throws the same errors at the slabs where they were met. What is left of the volume before is dropped.
  /// @return a source that must not outlive this  @throw Error  as the volume does when it is opened
  /// @pre there are more volumes
  std::unique_ptr<VoxelSource> next();

  struct Queue;  // what has been read and waits to be used

 private:
  std::unique_ptr<Queue> queue_;
};

}  // namespace umbrick
