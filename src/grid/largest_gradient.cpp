// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "grid/leaf_visits.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/value_survey.h"

namespace umbrick {
namespace {

struct Largest {
  double square = 0;
  void add(const Largest& other) { square = std::max(square, other.square); }
};

// Looks at single voxels. Non-finite ones count as background, as in bricks.
class Gradients {
 public:
  Gradients(const openvdb::FloatGrid& grid, const glm::dmat3& toWorld)
      : accessor_(grid.getConstAccessor()),
        background_(std::isfinite(grid.background()) ? grid.background() : 0),
        toWorld_(toWorld) {}

  void look(const openvdb::Coord& at, Largest& largest) {
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Coord below = at, above = at;
      --below[axis];
      ++above[axis];
      slope[axis] = 0.5 * (valueAt(above) - valueAt(below));
    }
    const glm::dvec3 gradient = toWorld_ * slope;
    largest.square = std::max(largest.square, glm::dot(gradient, gradient));
  }

 private:
  double valueAt(const openvdb::Coord& at) {
    const float value = accessor_.getValue(at);
    return std::isfinite(value) ? value : background_;
  }

  openvdb::FloatGrid::ConstAccessor accessor_;
  double background_;
  glm::dmat3 toWorld_;
};

// Inside a tile all voxels are equal: only those at its faces have a gradient.
void lookAtFaces(const openvdb::CoordBBox& box, Gradients& gradients, Largest& largest) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int face : {box.min()[axis], box.max()[axis]}) {
      openvdb::CoordBBox side = box;
      side.min()[axis] = side.max()[axis] = face;
      for (auto at = side.begin(); at; ++at) gradients.look(*at, largest);
    }
}

}  // namespace

double largestGradient(const ScalarGrid& grid) {
  const openvdb::FloatTree& tree = grid.grid->tree();
  const glm::dmat3 toWorld = glm::transpose(glm::inverse(glm::dmat3(grid.indexToWorld())));
  const FloatLeaves leaves(tree);
  Largest largest = overLeaves(leaves, Largest{}, [&](const FloatLeaf& leaf, Largest& state) {
    Gradients gradients(*grid.grid, toWorld);
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) gradients.look(voxel.getCoord(), state);
  });
  Gradients gradients(*grid.grid, toWorld);
  visitTiles(tree, [&](float, const openvdb::CoordBBox& box) { lookAtFaces(box, gradients, largest); });
  return std::sqrt(largest.square);
}

}  // namespace umbrick
