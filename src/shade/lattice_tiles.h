// Tiles of the light's lattice tell where, on each slice, light has work to do.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "shade/light_geometry.h"

namespace umbrick {

/// Lists, slice by slice, the tiles of kLatticeTile x kLatticeTile texels of the lattice that hold something
/// seen or occluding. Light is taken through a slice in its tiles only: elsewhere nothing dims a path, and
/// nobody asks what arrives.
struct LatticeTiles {
  std::vector<std::uint32_t> places;  // tiles of all slices: column + (row << kTileRowShift), row by row
  std::vector<std::size_t> start{0};  // the tiles of slice i are [start[i], start[i + 1])

  /// Returns the tiles of slices [first, last].
  std::span<const std::uint32_t> of(std::int64_t first, std::int64_t last) const {
    const std::size_t begin = start[static_cast<std::size_t>(first)];
    return std::span(places).subspan(begin, start[static_cast<std::size_t>(last) + 1] - begin);
  }
};

LatticeTiles latticeTiles(const LightGeometry& light, const LitVolume& volume);

}  // namespace umbrick
