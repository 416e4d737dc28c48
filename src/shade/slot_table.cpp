// SPDX-License-Identifier: Apache-2.0
#include "shade/slot_table.h"

#include <algorithm>
#include <utility>

#include "shade/constants.h"

namespace umbrick {

bool SlotTable::fits(const CellBox& cells) {
  const glm::i64vec3& count = cells.count;
  return std::max({count.x, count.y, count.z}) <= kMostEdge && count.x * count.y * count.z <= kMostCells;
}

std::vector<int> SlotTable::texturesOf(const BrickSelection& bricks, std::span<const std::int32_t> positions) {
  std::vector<int> textures;
  for (const std::int32_t position : positions) {
    const int texture = bricks.slot(position).texture;
    const auto place = std::lower_bound(textures.begin(), textures.end(), texture);
    if (place == textures.end() || *place != texture) textures.insert(place, texture);
  }
  return textures;
}

// Writes into the texels of empty cells how many steps to any of 26 neighbours the next brick is away: in two passes,
// each of which looks at the neighbours that it has already been at (Borgefors 1986, chessboard distance,
// doi:10.1016/S0734-189X(86)80047-0).
void SlotTable::measureDistances(const glm::ivec3& count) {
  std::vector<std::array<int, 3>> before;  // of the 26 neighbours, those that come before in memory
  for (int z = -1; z <= 0; ++z)
    for (int y = -1; y <= (z < 0 ? 1 : 0); ++y)
      for (int x = -1; x <= (z < 0 || y < 0 ? 1 : -1); ++x) before.push_back({x, y, z});
  const auto at = [&](int x, int y, int z) -> Texel& {
    return texels_[(static_cast<std::size_t>(z) * static_cast<std::size_t>(count.y) + static_cast<std::size_t>(y)) *
                       static_cast<std::size_t>(count.x) +
                   static_cast<std::size_t>(x)];
  };
  const auto look = [&](int x, int y, int z, int sign) {
    Texel& here = at(x, y, z);
    if (here[3] != 0) return;
    int least = here[0];
    for (const auto& step : before) {
      const int i = x + sign * step[0], j = y + sign * step[1], k = z + sign * step[2];
      if (i < 0 || j < 0 || k < 0 || i >= count.x || j >= count.y || k >= count.z) continue;
      const Texel& there = at(i, j, k);
      least = std::min(least, there[3] != 0 ? 1 : there[0] + 1);
    }
    here[0] = static_cast<std::uint16_t>(least);
  };
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) look(x, y, z, 1);
  for (int z = count.z - 1; z >= 0; --z)
    for (int y = count.y - 1; y >= 0; --y)
      for (int x = count.x - 1; x >= 0; --x) look(x, y, z, -1);
}

void SlotTable::write(const BrickSelection& bricks, const SlotCells& cells) {
  const BrickAtlas& atlas = bricks.atlas();
  const glm::ivec3 count(cells.cells.count), parts = cells.parts, edge = atlas.layout().interior / parts;
  const std::size_t perBrick = cells.shown.size() / cells.positions.size();
  // No cell is farther from another than this.
  constexpr auto kFar = static_cast<std::uint16_t>(2 * kMostEdge);
  texels_.assign(
      static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) * static_cast<std::size_t>(count.z),
      Texel{kFar, 0, 0, 0});
  numbers_.assign(cells.bounds.empty() ? 0 : texels_.size(), 0.0f);
  for (std::size_t i = 0; i < cells.positions.size(); ++i) {
    const std::int32_t position = cells.positions[i];
    const std::span<const std::uint8_t> shown = cells.shown.subspan(i * perBrick, perBrick);
    const glm::ivec3 first((glm::i64vec3(bricks.origins()[static_cast<std::size_t>(position)]) - cells.cells.first) /
                           glm::i64vec3(edge));
    const BrickAtlas::Slot slot = bricks.slot(position);
    const auto seen = static_cast<std::size_t>(std::count(shown.begin(), shown.end(), std::uint8_t{1}));
    const bool whole = (cells.joins || perBrick == 1) && 4 * seen >= 3 * perBrick;
    const auto texture =
        static_cast<unsigned>(std::ranges::find(cells.textures, slot.texture) - cells.textures.begin());
    const auto code = static_cast<std::uint16_t>(texture + 1 + (whole ? kWholeBrick : 0));
    std::size_t part = 0;
    for (int z = 0; z < parts.z; ++z)
      for (int y = 0; y < parts.y; ++y)
        for (int x = 0; x < parts.x; ++x, ++part) {
          if (!whole && !shown[part]) continue;
          const glm::ivec3 cell = first + glm::ivec3(x, y, z);
          const glm::ivec3 texel = slot.origin + (whole ? glm::ivec3(0) : glm::ivec3(x, y, z) * edge);
          const std::size_t at = (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(count.y) +
                                  static_cast<std::size_t>(cell.y)) *
                                     static_cast<std::size_t>(count.x) +
                                 static_cast<std::size_t>(cell.x);
          texels_[at] = {static_cast<std::uint16_t>(texel.x), static_cast<std::uint16_t>(texel.y),
                         static_cast<std::uint16_t>(texel.z), code};
          if (!numbers_.empty()) numbers_[at] = cells.bounds[i * perBrick + part];
        }
  }
}

void SlotTable::fill(const GlFunctions& gl, const BrickSelection& bricks, const SlotCells& cells) {
  Key key{cells.cells, bricks.atlas().generation(), cells.version,  cells.parts,
          cells.joins, !cells.bounds.empty(),       cells.textures, {},
          {}};
  for (const std::int32_t position : cells.positions) {
    key.origins.push_back(bricks.origins()[static_cast<std::size_t>(position)]);
    key.slots.push_back(bricks.slotNumber(position));
  }
  if (key == held_) return;
  held_ = {};  // whatever fails next
  const glm::ivec3 count(cells.cells.count);
  write(bricks, cells);
  measureDistances(count);
  upload(gl, count);
  uploadBounds(gl, count);
  checkGl(gl, "table of slots");
  held_ = std::move(key);
  texels_.clear();
}

void SlotTable::upload(const GlFunctions& gl, const glm::ivec3& count) {
  if (size_ != count) {
    texture_ = makeTexture3d(gl, GL_RGBA16UI, count.x, count.y, count.z);
    gl.TextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);  // whole numbers have no mean
    gl.TextureParameteri(texture_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    size_ = count;
  }
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TextureSubImage3D(texture_.name(), 0, 0, 0, 0, count.x, count.y, count.z, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
                       texels_.data());
}

void SlotTable::uploadBounds(const GlFunctions& gl, const glm::ivec3& count) {
  if (numbers_.empty()) return;
  if (boundsSize_ != count) {
    bounds_ = makeTexture3d(gl, GL_R32F, count.x, count.y, count.z);
    gl.TextureParameteri(bounds_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TextureParameteri(bounds_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    boundsSize_ = count;
  }
  gl.TextureSubImage3D(bounds_.name(), 0, 0, 0, 0, count.x, count.y, count.z, GL_RED, GL_FLOAT, numbers_.data());
  numbers_.clear();
}

std::uint64_t SlotTable::bytes() const {
  const auto cells = [](const glm::ivec3& size) {
    return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(size.z);
  };
  return cells(size_) * sizeof(Texel) + cells(boundsSize_) * sizeof(float);
}

}  // namespace umbrick
