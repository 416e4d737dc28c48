// The polygons of a run of slices as vertices and triangles in graphics memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "shade/screen_region.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/gl/objects.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Triangles of one slice whose bricks lie in one texture.
struct SliceDraw {
  std::int64_t slice = 0;
  int texture = 0;
  std::int32_t firstIndex = 0, indices = 0;
};

class PolygonBuffer {
 public:
  explicit PolygonBuffer(const GlFunctions& gl);
  /// Fills the buffer with slices [first, last), whose bricks are resident. Vertices carry where in the atlas the slice
  /// plane meets the centre of the image. This is computed in double precision from indices relative to the brick, so
  /// that volumes far from the origin lose nothing.
  /// @param layers  for each slice from `first`: a number that goes with its vertices; negative: leave the slice out.
  ///   An empty list stands for 0 on every slice.
  void fill(const ProxySlices& slices, std::int64_t first, std::int64_t last, const IndexView& view,
            const BrickSelection& bricks, bool reverseBricks, std::span<const int> layers = {});
  /// Returns the draws of all slices, in order.
  const std::vector<SliceDraw>& draws() const { return draws_; }
  /// Returns the draws of slices [first, last).
  std::span<const SliceDraw> drawsOf(std::int64_t first, std::int64_t last) const;
  void bind() const;
  /// Draws consecutive triangles.
  void draw(std::int32_t firstIndex, std::int32_t indices) const;

 private:
  struct Vertex {
    float x, y;        // normalised device coordinates
    float u, v, w, s;  // atlas coordinates at the centre of the image; depth
    float layer;
  };
  const GlFunctions& gl_;
  GlVertexArray array_;
  GlBuffer vertices_, indices_;
  std::vector<SliceDraw> draws_;
  std::vector<Vertex> vertexData_;
  std::vector<std::uint32_t> indexData_;
};

/// Returns a rectangle around the pixels that polygons [first, last) may cover.
ScreenRegion coveredRegion(const ProxySlices& slices, std::int32_t first, std::int32_t last, const glm::ivec2& size);

}  // namespace umbrick
