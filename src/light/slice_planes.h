// Slices of bricks as planes: what a sweep reads, and what it adds.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "core/large_vector.h"
#include "light/cell_store.h"
#include "light/mesh_shadow.h"
#include "light/sweep_kernels.h"
#include "umbrick/light/extinction_table.h"

namespace umbrick {

/// The visible bricks as sweeps read and light them. All arrays are by brick and x fastest within.
struct SweptBricks {
  BrickLayout layout;
  LightLayout light;
  std::vector<glm::ivec3> origins;  // first owned voxels
  std::vector<LitBlocks> lit;
  std::shared_ptr<const LargeVector<float>> values;  // with aprons, in steps of the table
  int channels = 1;
  LargeVector<std::int32_t> sums;  // of light, channel by channel within a brick
  const ExtinctionTable* extinction = nullptr;
  std::vector<PathSurface> surfaces;     // that keep light away
  std::vector<glm::dvec4> planes;        // see LightMedium
  const IndexTriangles* mesh = nullptr;  // that ends paths; null: there is none
  glm::dmat3 toIndex{1};                 // of directions, from the world
  std::unique_ptr<std::mutex[]> busy;    // one for the sums of each brick
};

/// A plane of numbers, row by row.
template <class Number>
class Plane {
 public:
  Plane() = default;
  Plane(int width, int height, int padding)
      : width_(width),
        numbers_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + static_cast<std::size_t>(padding),
                 Number{}) {}
  Number* row(int r, int column) { return numbers_.data() + std::ptrdiff_t(r) * width_ + column; }

 private:
  int width_ = 0;
  std::vector<Number> numbers_;
};

/// So many slices are read and lit together, since rows of bricks that are neighbours in memory lie on several. Along x
/// even the voxels of a row do.
inline constexpr int kSlicesTogether = 8;
inline int slicesTogether(const SweepAxes& axes) { return axes.n == 0 ? kSlicesTogether : kSlicesTogether / 2; }

/// The values of the slice that a sweep is at, and of the one before.
class ValuePlanes {
 public:
  ValuePlanes(const SweptBricks& bricks, const SweepLattice& lattice);
  /// Brings a slice to its plane, if it is not there. @param window  of places of light, around which values are needed
  void require(int n, const PlaneWindow& window);
  /// Returns the values from a voxel on. @pre the slice is among the last two that were required
  const float* row(int n, int r, int column) { return plane(n).row(r, column); }

 private:
  Plane<float>& plane(int n) { return planes_[static_cast<std::size_t>(n - first_) % planes_.size()]; }
  void put(int brick, const glm::ivec3& place, int first, int last, int beyond, int beyondSlices);
  const SweptBricks& bricks_;
  const SweepLattice& lattice_;
  int together_, first_;
  std::vector<Plane<float>> planes_;
  std::array<int, 2> held_;  // numbers of the slices that were brought together
};

/// The light of a slice, by channel, before it is added to the bricks.
class LightPlanes {
 public:
  LightPlanes(SweptBricks& bricks, const SweepLattice& lattice);
  std::int32_t* row(int n, int channel, int r, int column) { return plane(n, channel).row(r, column); }
  /// Makes room for a slice: adds to the bricks what slices hold that are not added together with it.
  void begin(int n);
  /// @param window  of places of light outside of which the slice has none
  void end(int n, const PlaneWindow& window);
  /// Adds the rest to the bricks.
  void finish();

 private:
  Plane<std::int32_t>& plane(int n, int channel) {
    return planes_[static_cast<std::size_t>(((n - first_) % together_) * bricks_.channels + channel)];
  }
  int groupOf(int n) const { return (n - first_) / together_; }
  void addTo(int brick, const glm::ivec3& place);
  SweptBricks& bricks_;
  const SweepLattice& lattice_;
  int together_, first_;
  std::vector<Plane<std::int32_t>> planes_;
  std::vector<int> lit_;  // slices that hold light
  PlaneWindow window_;
};

}  // namespace umbrick
