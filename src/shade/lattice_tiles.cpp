// SPDX-License-Identifier: Apache-2.0
#include "shade/lattice_tiles.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "shade/constants.h"

namespace umbrick {
namespace {

// The tiles of one slice, marked and then listed.
class TileMarks {
 public:
  explicit TileMarks(const LightLattice& lattice)
      : origin_(lattice.first),
        grid_((lattice.size + kLatticeTile - 1) / kLatticeTile),
        marked_(static_cast<std::size_t>(grid_.x) * static_cast<std::size_t>(grid_.y), false) {}

  // Marks the tiles that a rectangle of lattice texels touches.
  void mark(const Rectangle& texels) {
    if (texels.empty()) return;
    const glm::ivec2 low = glm::max(tileOf(texels.min), glm::ivec2(0));
    const glm::ivec2 high = glm::min(tileOf(texels.max), grid_ - 1);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) marked_[at(x, y)] = true;
  }

  std::vector<std::uint32_t> places() const {
    std::vector<std::uint32_t> places;
    for (int y = 0; y < grid_.y; ++y)
      for (int x = 0; x < grid_.x; ++x)
        if (marked_[at(x, y)])
          places.push_back(static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << kTileRowShift);
    return places;
  }

 private:
  glm::ivec2 tileOf(const glm::dvec2& texel) const {
    return glm::ivec2(glm::floor((texel - origin_) / double(kLatticeTile)));
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.x) + static_cast<std::size_t>(x);
  }
  glm::dvec2 origin_;
  glm::ivec2 grid_;
  std::vector<bool> marked_;
};

std::vector<std::uint32_t> tilesOf(std::size_t slice, const LightGeometry& light, const LitVolume& volume) {
  TileMarks marks(light.lattice);
  const auto i = static_cast<std::int64_t>(slice);
  // The eye interpolates between texels, so that it reads the neighbours of those that it sees.
  forEachPolygon(light.seen(volume), i, [&](const Rectangle& texels) { marks.mark(texels.grown(1)); });
  forEachPolygon(light.occluding(), i,
                 [&](const Rectangle& texels) { marks.mark(texels.within(light.extents.occluding[slice])); });
  return marks.places();
}

}  // namespace

LatticeTiles latticeTiles(const LightGeometry& light, const LitVolume& volume) {
  const std::size_t count = light.extents.depths.size();
  std::vector<std::vector<std::uint32_t>> bySlice(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      if (!light.extents.holdsNothing(i)) bySlice[i] = tilesOf(i, light, volume);
  });
  LatticeTiles tiles;
  for (const std::vector<std::uint32_t>& places : bySlice) {
    tiles.places.insert(tiles.places.end(), places.begin(), places.end());
    tiles.start.push_back(tiles.places.size());
  }
  return tiles;
}

}  // namespace umbrick
