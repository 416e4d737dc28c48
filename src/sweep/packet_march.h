// A square of pixels' rays on their way through the slices of voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "sweep/brick_table.h"
#include "sweep/packet_kernels.h"
#include "sweep/swept_frame.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Index space along the main axis n of a packet: what all packets of one axis share, along (u, v, n).
struct PacketAxes {
  int u = 0, v = 1, n = 2;
  glm::dvec3 eye{0};                   // index coordinates
  std::array<glm::dvec3, 3> screen{};  // screen point p is seen along screen[0] p.x + screen[1] p.y + screen[2]
  glm::dmat3 metric{1};                // world length squared: a quadratic form
  glm::dvec4 depth{0};                 // of (u, v, n, 1), along the view axis, world units
  std::vector<glm::dvec4> planes;      // the medium lies where dot + w >= 0
  glm::dvec3 low{0}, high{0};          // of what is visible
};

/// What all packets of a picture share.
struct PacketFrame : SweptFrame {
  const BrickTable* bricks = nullptr;
  std::array<PacketAxes, 3> axes;  // by n
  bool perspective = true;
  double perVoxel = 1;  // slices
};

/// What the rays of a packet have gathered.
struct PacketPixels {
  std::array<glm::vec4, kRayGroup> colour;
  std::array<glm::vec2, kRayGroup> aux;
  std::array<glm::vec3, kRayGroup> emitted;
};

/// Where rays begin and end, depths along the view axis, world units.
struct PacketDepths {
  std::array<double, kRayGroup> start{}, end{};
};

/// Takes packets through the slices, one after another. Each thread has one.
class PacketMarch {
 public:
  explicit PacketMarch(const PacketFrame& frame);

  /// @param screen  the points of the screen that the rays are seen through
  /// @param depths  between which rays see something; null: from the eye on
  /// @return the number of samples that were integrated
  std::uint64_t march(const std::array<glm::dvec2, kRayGroup>& screen, PacketPixels& pixels,
                      const PacketDepths* depths = nullptr);

 private:
  void marchTogether(PacketPixels& pixels, const PacketDepths* depths);
  using Lanes = std::array<float, kRayGroup>;
  // The bricks of a part of a layer, as they were listed last: those that are not held first.
  struct Listed {
    std::array<std::int64_t, 5> cells{};  // of u, v and n
    int axis = -1;
    std::vector<const PlacedBrick*> entries;
  };
  struct Extent {
    double low = 0, high = 0;
  };
  bool aim(const std::array<glm::dvec2, kRayGroup>& screen);
  bool enterBox();
  void clip(const PacketDepths* depths);
  void marchLayers();
  bool isActive(double from, double to, std::int64_t layer);
  bool hasBricks(double from, double to, std::int64_t cellN);
  Extent extent(int across, double from, double to) const {
    const glm::dvec4& b = bounds_[static_cast<std::size_t>(across)];
    return {std::min(b.x + b.y * from, b.x + b.y * to), std::max(b.z + b.w * from, b.z + b.w * to)};
  }
  double middleAt(int across, double n) const {
    return places_[static_cast<std::size_t>(across)].x + places_[static_cast<std::size_t>(across)].y * n;
  }
  double spreadAt(double n) const { return frame_.perspective ? n - axes_->eye.z : 1; }
  void segment(double from, double to);
  void sample(double n, int side);
  void addBricks(std::int64_t n, std::int64_t layer, Listed& listed);

  const PacketFrame& frame_;
  const PacketAxes* axes_ = nullptr;
  int sign_ = 1;
  // Slopes of the middle ray (perspective), or its place on the plane through the eye and its slopes (parallel).
  glm::dvec2 middle_{0}, slope_{0};
  std::array<glm::dvec2, 2> places_{};  // of the middle ray along u and v: x + y n
  // Of all rays in front of the eye, along u and v: between x + y n and z + w n.
  std::array<glm::dvec4, 2> bounds_{};
  Lanes acrossU_{}, acrossV_{};  // the same by ray
  std::array<glm::dvec2, kRayGroup> exact_{};
  std::array<glm::dvec2, kRayGroup> placesByDepth_{};  // along n: x + y depth
  std::array<Lanes, 3> emitted_{};
  Lanes red_{}, green_{}, blue_{}, opacity_{}, seen_{}, depth_{}, length_{}, enter_{}, leave_{};
  std::array<std::array<Lanes, kMostFields>, 2> fields_{};
  std::array<double, 2> sampledAt_{};  // along n
  std::array<bool, 2> isSampled_{};
  std::uint8_t full_ = 0;
  bool clipped_ = false;         // rays begin or end on their way
  double first_ = 0, last_ = 0;  // along n, front and back
  float firstEnter_ = 0, lastEnter_ = 0, firstLeave_ = 0, lastLeave_ = 0;
  std::vector<PacketBrick> bricks_;
  std::array<Listed, 3> listed_;
  std::int64_t baseU_ = 0, baseV_ = 0;  // the packet's voxel on the slice
  Extent cellsU_, cellsV_;              // that rays are in, on the slice
  std::uint64_t samples_ = 0;
};

}  // namespace umbrick
