// SPDX-License-Identifier: Apache-2.0
#include "sweep/classified_voxels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace umbrick {

void classify(BrickVoxels& voxels, const TransferFunction& transfer, double most) {
  const Bricks& volume = voxels.volume();
  const std::size_t count = volume.layout.voxels();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, voxels.bricks().size(), 1), [&](const auto& range) {
    std::vector<float> values(count), gradients(transfer.is2d() ? count : 0);
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      VoxelBrick& brick = voxels.brick(i);
      volume.read(brick.origin, values, gradients);
      if (!brick.media)
        brick.media = std::make_unique_for_overwrite<float[]>(count * kMediumNumbers + BrickVoxels::kPadding);
      for (std::size_t v = 0; v < count; ++v) {
        const Medium medium = transfer(values[v], transfer.is2d() ? gradients[v] : 0);
        const double sigma_t = std::min(medium.sigma_t, most);
        brick.media[v] = static_cast<float>(sigma_t);
        for (std::size_t c = 0; c < 3; ++c)
          brick.media[(c + 1) * count + v] = static_cast<float>(sigma_t * medium.albedo[static_cast<int>(c)]);
      }
    }
  });
}

void forgetMedia(BrickVoxels& voxels) {
  for (std::size_t i = 0; i < voxels.bricks().size(); ++i) voxels.brick(i).media.reset();
}

}  // namespace umbrick
