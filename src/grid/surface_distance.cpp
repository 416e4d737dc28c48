// SPDX-License-Identifier: Apache-2.0
#include "grid/surface_distance.h"

#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "grid/crossing_edges.h"

namespace umbrick {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;

class DiscMaker {
 public:
  DiscMaker(const FloatTree& field, float value, bool activeOnly, const glm::dmat4& toBand)
      : field_(field),
        value_(value),
        activeOnly_(activeOnly),
        same_(toBand == glm::dmat4(1)),
        toBand_(toBand),
        turn_(glm::transpose(glm::inverse(glm::dmat3(toBand)))) {}

  // Makes the disc of an edge. @param origin  becomes that of the leaf that the disc lies in
  std::optional<Disc> disc(const Coord& at, int axis, int side, Coord& origin) const {
    Coord next = at;
    next[axis] += side;
    if (activeOnly_ && !(field_.isValueOn(at) && field_.isValueOn(next))) return std::nullopt;
    const float here = field_.getValue(at), there = field_.getValue(next);
    const float share = (value_ - here) / (there - here);
    glm::dvec3 normal, centre(at.x(), at.y(), at.z());
    for (int k = 0; k < 3; ++k)
      normal[k] =
          k == axis ? static_cast<float>(side) * (there - here) : (1 - share) * slope(at, k) + share * slope(next, k);
    centre[axis] += static_cast<double>(side) * static_cast<double>(share);
    if (!same_) {
      centre = glm::dvec3(toBand_ * glm::dvec4(centre, 1));
      normal = turn_ * normal;
    }
    const glm::dvec3 whole = glm::floor(centre);
    origin = same_ ? at : Coord(static_cast<int>(whole.x), static_cast<int>(whole.y), static_cast<int>(whole.z));
    origin &= ~(Leaf::DIM - 1);
    normal /= glm::length(normal);
    Disc made;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      made.normal[i] = static_cast<float>(normal[k]);
      made.centre[i] = static_cast<float>(centre[k] - origin[k]);
    }
    return made;
  }

 private:
  float slope(Coord at, int axis) const {
    ++at[axis];
    const float after = field_.getValue(at);
    at[axis] -= 2;
    return 0.5f * (after - field_.getValue(at));
  }

  openvdb::tree::ValueAccessor<const FloatTree> field_;
  float value_;
  bool activeOnly_, same_;
  glm::dmat4 toBand_;
  glm::dmat3 turn_;  // of normals
};

// The leaves that the band may touch.
FloatTree bandLeaves(const std::vector<LeafDiscs>& discs, float halfWidth) {
  FloatTree tree(halfWidth);
  constexpr int kEdge = Leaf::DIM;
  for (const LeafDiscs& leaf : discs)
    for (int x = -kEdge; x <= kEdge; x += kEdge)
      for (int y = -kEdge; y <= kEdge; y += kEdge)
        for (int z = -kEdge; z <= kEdge; z += kEdge) tree.touchLeaf(leaf.origin.offsetBy(x, y, z));
  return tree;
}

}  // namespace

std::vector<LeafDiscs> surfaceDiscs(const FloatTree& field, float value, bool activeOnly, const glm::dmat4& toBand) {
  // Those of each leaf of the field, by the leaf of the band that they lie in: one where the lattices are the same.
  using Parts = std::map<Coord, std::vector<Disc>>;
  openvdb::tree::LeafManager<const FloatTree> leaves(field);
  std::vector<Parts> parts(leaves.leafCount() + 1);
  const auto add = [](const DiscMaker& maker, Parts& to) {
    return [&maker, &to](const Coord& at, int axis, int side) {
      Coord origin;
      if (const auto disc = maker.disc(at, axis, side, origin)) to[origin].push_back(*disc);
    };
  };
  leaves.foreach ([&](const Leaf& leaf, std::size_t i) {
    const DiscMaker maker(field, value, activeOnly, toBand);
    CrossingEdges(field, value).inLeaf(leaf, add(maker, parts[i]));
  });
  const DiscMaker maker(field, value, activeOnly, toBand);
  CrossingEdges edges(field, value);
  eachTileOf(field,
             [&](const openvdb::CoordBBox& box, float here) { edges.inTile(box, here, add(maker, parts.back())); });
  std::vector<LeafDiscs> found;
  for (Parts& part : parts)
    for (auto& [origin, discs] : part) found.push_back({origin, std::move(discs)});
  return found;
}

FloatGrid::Ptr distanceBand(const std::vector<LeafDiscs>& discs, float halfWidth,
                            const std::function<std::function<bool(const Coord&)>()>& isInside) {
  std::unordered_multimap<Coord, const LeafDiscs*> places;
  for (const LeafDiscs& leaf : discs) places.emplace(leaf.origin, &leaf);
  const auto out = FloatGrid::create(std::make_shared<FloatTree>(bandLeaves(discs, halfWidth)));
  openvdb::tree::LeafManager<FloatTree> leaves(out->tree());
  leaves.foreach ([&](Leaf& leaf, std::size_t) {
    NearestDiscs nearest;
    nearest.fill(halfWidth * halfWidth);
    constexpr int kEdge = Leaf::DIM;
    for (int x = -kEdge; x <= kEdge; x += kEdge)
      for (int y = -kEdge; y <= kEdge; y += kEdge)
        for (int z = -kEdge; z <= kEdge; z += kEdge) {
          const Coord shift(x, y, z);
          const auto [begin, end] = places.equal_range(leaf.origin() + shift);
          for (auto part = begin; part != end; ++part)
            addDiscs(part->second->discs, {x, y, z}, halfWidth + kDiscRadius, nearest);
        }
    const auto inside = isInside();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      if (!(nearest[i] < halfWidth * halfWidth)) continue;
      const float distance = std::sqrt(nearest[i]);
      leaf.setValueOn(i, inside(leaf.offsetToGlobalCoord(i)) ? -distance : distance);
    }
  });
  openvdb::tools::pruneInactive(out->tree());
  openvdb::tools::signedFloodFill(out->tree());
  return out;
}

}  // namespace umbrick
