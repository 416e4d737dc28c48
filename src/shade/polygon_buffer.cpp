// SPDX-License-Identifier: Apache-2.0
#include "shade/polygon_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "shade/constants.h"

namespace umbrick {

PolygonBuffer::PolygonBuffer(const GlFunctions& gl) : gl_(gl), array_(gl), vertices_(gl), indices_(gl) {
  const GLuint array = array_.name();
  gl.VertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(Vertex));
  gl.VertexArrayElementBuffer(array, indices_.name());
  gl.VertexArrayAttribFormat(array, kPositionAttribute, 2, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribFormat(array, kSlabAttribute, 4, GL_FLOAT, GL_FALSE, offsetof(Vertex, u));
  gl.VertexArrayAttribFormat(array, kLayerAttribute, 1, GL_FLOAT, GL_FALSE, offsetof(Vertex, layer));
  for (const GLuint attribute : {kPositionAttribute, kSlabAttribute, kLayerAttribute}) {
    gl.VertexArrayAttribBinding(array, attribute, 0);
    gl.EnableVertexArrayAttrib(array, attribute);
  }
}

void PolygonBuffer::fill(const ProxySlices& slices, std::int64_t first, std::int64_t last, const IndexView& view,
                         const BrickSelection& bricks, bool reverseBricks, std::span<const int> layers) {
  const BrickAtlas& atlas = bricks.atlas();
  vertexData_.clear();
  indexData_.clear();
  draws_.clear();
  const glm::dvec3 size(atlas.textureSize());
  const double apron = atlas.layout().apron;
  std::vector<const ProxyPolygon*> order;
  for (std::int64_t i = first; i < last; ++i) {
    const int layer = layers.empty() ? 0 : layers[static_cast<std::size_t>(i - first)];
    if (layer < 0) continue;
    const double depth = slices.depth(i);
    const glm::dvec3 centre = view.eyeIndex + depth * slices.perDepth;  // of the slice, index coordinates
    order.clear();
    for (int p = slices.start[static_cast<std::size_t>(i)]; p < slices.start[static_cast<std::size_t>(i) + 1]; ++p)
      order.push_back(&slices.polygons[static_cast<std::size_t>(p)]);
    if (reverseBricks) std::reverse(order.begin(), order.end());
    // There is one draw for each texture; within a slice the order of bricks makes no difference.
    for (int texture = 0; texture < atlas.textureCount(); ++texture) {
      SliceDraw draw{i, texture, static_cast<std::int32_t>(indexData_.size()), 0};
      for (const ProxyPolygon* polygon : order) {
        const BrickAtlas::Slot slot = bricks.slot(polygon->brick);
        if (slot.texture != texture) continue;
        const glm::dvec3 origin(bricks.origins()[static_cast<std::size_t>(polygon->brick)]);
        const glm::vec3 uvw((glm::dvec3(slot.origin) + (centre - origin) + (apron + 0.5)) / size);
        const auto base = static_cast<std::uint32_t>(vertexData_.size());
        for (int v = 0; v < polygon->vertices; ++v) {
          const glm::vec2 device = slices.vertices[static_cast<std::size_t>(polygon->firstVertex + v)];
          vertexData_.push_back(
              {device.x, device.y, uvw.x, uvw.y, uvw.z, static_cast<float>(depth), static_cast<float>(layer)});
        }
        for (std::uint32_t v = 2; v < static_cast<std::uint32_t>(polygon->vertices); ++v)
          indexData_.insert(indexData_.end(), {base, base + v - 1, base + v});
      }
      draw.indices = static_cast<std::int32_t>(indexData_.size()) - draw.firstIndex;
      if (draw.indices > 0) draws_.push_back(draw);
    }
  }
  gl_.NamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(vertexData_.size() * sizeof(Vertex)),
                      vertexData_.data(), GL_STREAM_DRAW);
  gl_.NamedBufferData(indices_.name(), static_cast<GLsizeiptr>(indexData_.size() * sizeof(std::uint32_t)),
                      indexData_.data(), GL_STREAM_DRAW);
}

std::span<const SliceDraw> PolygonBuffer::drawsOf(std::int64_t first, std::int64_t last) const {
  const auto begin = std::ranges::lower_bound(draws_, first, {}, &SliceDraw::slice);
  return {begin, std::ranges::lower_bound(begin, draws_.end(), last, {}, &SliceDraw::slice)};
}

void PolygonBuffer::bind() const { gl_.BindVertexArray(array_.name()); }

void PolygonBuffer::draw(std::int32_t firstIndex, std::int32_t indices) const {
  // The offset into the buffer travels as a pointer, as OpenGL wants.
  gl_.DrawElements(GL_TRIANGLES, indices, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(static_cast<std::size_t>(firstIndex) * sizeof(std::uint32_t)));
}

ScreenRegion coveredRegion(const ProxySlices& slices, std::int32_t first, std::int32_t last, const glm::ivec2& size) {
  glm::vec2 low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
  for (int p = first; p < last; ++p) {
    const ProxyPolygon& polygon = slices.polygons[static_cast<std::size_t>(p)];
    for (int v = 0; v < polygon.vertices; ++v) {
      const glm::vec2 device = slices.vertices[static_cast<std::size_t>(polygon.firstVertex + v)];
      low = {std::min(low.x, device.x), std::min(low.y, device.y)};
      high = {std::max(high.x, device.x), std::max(high.y, device.y)};
    }
  }
  if (first >= last) return {};
  ScreenRegion region;
  for (int axis = 0; axis < 2; ++axis) {
    const auto toPixels = [&](float device) {
      return std::clamp(0.5f * (device + 1), 0.0f, 1.0f) * static_cast<float>(size[axis]);
    };
    // One pixel more on each side allows for the rasteriser's snapping.
    region.min[axis] = std::max(0, static_cast<int>(std::floor(toPixels(low[axis]))) - 1);
    region.max[axis] = std::min(size[axis], static_cast<int>(std::ceil(toPixels(high[axis]))) + 1);
  }
  return region;
}

}  // namespace umbrick
