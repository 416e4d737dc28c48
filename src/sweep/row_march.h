// A row of rays on its way through the slices of voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "sweep/brick_rows.h"
#include "sweep/ray_lattice.h"
#include "sweep/row_kernels.h"
#include "sweep/swept_frame.h"
#include "sweep/warp.h"

namespace umbrick {

/// A slice, and where rays are on it: ray (i, j) at start + spacing (i, j).
struct MarchSlice {
  double at = 0;  // along n
  glm::dvec2 start{0}, spacing{1};
};

/// What all rows of a picture share.
struct MarchFrame : SweptFrame {
  const RayLattice* lattice = nullptr;
  const BrickRows* rows = nullptr;
  std::vector<MarchSlice> slices;  // front to back
  std::vector<glm::dvec4> planes;  // along (u, v, n): the medium lies where dot + w >= 0
};

/// Takes rows of rays through the slices, one after another. Each thread has one.
class RowMarch {
 public:
  explicit RowMarch(const MarchFrame& frame);

  /// Fills row j of the picture. @return the number of samples that were integrated
  std::uint64_t march(int j, LatticePicture& picture);

 private:
  using Row = std::vector<float>;
  void storeAux(int j, glm::vec2* aux) const;
  void beginRow(int j);
  void clipRays(int j);
  bool findActive(std::size_t slice);
  void mark(const BrickRows::Cells& cells, std::size_t slice);
  void sample(int group, int groups, std::size_t slice);
  void integrate(int group, int groups, std::size_t slice);
  double rowAt(std::size_t slice) const { return frame_.slices[slice].start.y + j_ * frame_.slices[slice].spacing.y; }

  const MarchFrame& frame_;
  RowReader reader_;
  int groups_, j_ = 0;
  Row red_, green_, blue_, opacity_, seen_, depth_, length_, enter_, leave_;
  std::array<std::array<Row, kMostFields>, 2> fields_;                  // of the slices of even and of odd number
  std::array<std::vector<std::int64_t>, 2> sampled_;                    // by group: the slice that the fields hold
  std::vector<std::uint8_t> full_, active_;                             // by group
  std::vector<float> firstEnter_, lastEnter_, firstLeave_, lastLeave_;  // by group, where planes clip
  std::uint64_t samples_ = 0;
};

}  // namespace umbrick
