// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/voxel_source.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace umbrick {

void VoxelSource::skipSlices(std::int64_t count) {
  const std::int64_t sliceNumbers = info_.dims.x * info_.dims.y * info_.valuesPerVoxel;
  const std::int64_t atOnce =
      std::clamp<std::int64_t>((std::int64_t(1) << 22) / sliceNumbers, 1, std::max<std::int64_t>(count, 1));
  std::vector<float> dropped;
  for (std::int64_t done = 0; done < count; done += atOnce) {
    const std::int64_t slices = std::min(atOnce, count - done);
    dropped.resize(static_cast<std::size_t>(slices * sliceNumbers));
    readSlab(slices, dropped);
  }
}

void VoxelSource::readStored(std::int64_t, std::span<std::byte>) { assert(!"only where storedType() is something"); }

}  // namespace umbrick
