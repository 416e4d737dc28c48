// umbrick render of one picture whose samples are drawn by several ranks.
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <thread>

#include "dist/picture_bytes.h"
#include "progress.h"
#include "render_command.h"
#include "umbrick/draw/pixel_samples.h"

namespace umbrick::tools {

std::optional<Picture> renderTogether(Renderer& renderer, Ranks& ranks, const std::function<void(double)>& show) {
  const auto samples = static_cast<std::size_t>(renderer.scene().sampling.pixelSamples);
  // Pictures that wait for their turn are kept in memory.
  ranks.begin(samples, 2 * static_cast<std::size_t>(ranks.count()));
  PixelSampleMean mean;
  std::size_t added = 0;
  // Samples are added up in their order, so that the sum does not depend on who was how fast.
  const auto collect = [&] {
    while (const std::optional<ItemResult> result = ranks.collect()) {
      mean.add(pictureOfBytes(result->bytes));
      ++added;
    }
  };
  const auto wait = [&] {
    collect();
    const WorkDone done = ranks.show(0);
    show((static_cast<double>(done.items) + done.shares) / static_cast<double>(samples));
  };
  while (const std::optional<std::size_t> item = ranks.take(Ranks::When::now, wait)) {
    ranks.put(*item, bytesOfPicture(renderPixelSample(renderer, *item)));
    collect();
  }
  ranks.rest();
  if (!ranks.isFirst()) return {};
  while (!ranks.allRest()) {
    wait();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  collect();
  if (added < samples) throw Interrupted("interrupted; nothing was written");
  return mean.mean();
}

}  // namespace umbrick::tools
