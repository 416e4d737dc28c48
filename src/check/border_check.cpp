// SPDX-License-Identifier: Apache-2.0
#include "check/border_check.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "check/result.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Leaf = openvdb::FloatTree::LeafNodeType;

// Returns the leaf in the middle of those through which something is seen; null where there is none.
const Leaf* visibleLeaf(const openvdb::FloatGrid& grid, const TransferFunction& transfer) {
  std::vector<const Leaf*> leaves;
  grid.tree().getNodes(leaves);
  std::erase_if(leaves, [&](const Leaf* leaf) {
    Range range;
    for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
      if (std::isfinite(*voxel)) range.include(*voxel);
    return range.empty() || transfer.isTransparent(range, {0, 0});
  });
  return leaves.empty() ? nullptr : leaves[leaves.size() / 2];
}

// Returns the voxels of a box alone, with empty space around them if asked for.
ScalarGrid piece(const ScalarGrid& grid, const CoordBBox& box, bool roomAround) {
  const auto copy = openvdb::FloatGrid::create(grid.grid->background());
  copy->setTransform(grid.grid->transform().copy());
  const auto from = grid.grid->getConstAccessor();
  auto to = copy->getAccessor();
  for (auto voxel = box.begin(); voxel; ++voxel) {
    float value = 0;
    if (from.probeValue(*voxel, value))
      to.setValueOn(*voxel, value);
    else if (value != copy->background())
      to.setValueOff(*voxel, value);
  }
  if (roomAround) {
    to.setValueOn(box.min().offsetBy(-64), copy->background());
    to.setValueOn(box.max().offsetBy(64), copy->background());
  }
  ScalarGrid result = grid;
  result.grid = copy;
  return result;
}

}  // namespace

void checkBorder(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                 const std::function<std::unique_ptr<Bricks>(const ScalarGrid&, const BrickOptions&)>& cut,
                 const CheckSteps& steps, InvariantResult& result) {
  const float background = std::isfinite(grid.grid->background()) ? grid.grid->background() : 0;
  const Leaf* leaf = visibleLeaf(*grid.grid, scene.transfer);
  if (!leaf || !scene.transfer.isTransparent({background, background}, {0, 0})) return;
  for (int residue = 0; residue < 8; ++residue) {
    steps.within(residue / 8.0);
    const Coord first = leaf->origin().offsetBy(-8 - residue), last = leaf->origin().offsetBy(7 + residue);
    const CoordBBox box(first, last);
    const ScalarGrid alone = piece(grid, box, false);
    if (alone.activeBox().empty()) continue;
    Scene turned = unresolved(scene);
    turned.clipPlanes.clear();
    turned.clipBox.reset();
    turned.model = Model::emission;
    applyQuality(std::array{Quality::draft, Quality::normal, Quality::high}[static_cast<std::size_t>(residue % 3)],
                 turned);
    // A pixel is found to be saturated at some slice or other, which is not what is asked here.
    turned.sampling.saturation = 0;
    turned.bricks.interior = 0;
    turned.camera = Camera{};
    turned.camera.width = turned.camera.height = 64;
    turned.camera.projection = residue % 2 == 0 ? Projection::orthographic : Projection::perspective;
    // The camera looks at the piece from another place each time, so that each of its faces is in front or
    // behind some time.
    turned.orbit = Orbit{0.8 * residue, 0.9 - 0.25 * residue};
    const std::string spacing = std::to_string(turned.sampling.spacing);
    const ResolvedScene wide = resolveScene(turned, alone.worldBounds(), alone.indexToWorld());
    BrickOptions options;
    options.apron = requiredApron(wide, alone.indexToWorld());
    options.interior = brickInterior(wide, alone.indexToWorld(), alone.worldBounds());
    options.gradients = scene.transfer.is2d();
    options.gradientFilter = scene.gradients;
    const auto draw = [&](const ScalarGrid& volume) {
      const std::unique_ptr<Bricks> bricks = cut(volume, options);
      return SliceRenderer(context, *bricks, wide).render().colour;
    };
    const Image found = draw(alone), whole = draw(piece(grid, box, true));
    double largest = 0;
    for (std::size_t i = 0; i < found.pixels.size(); ++i)
      largest = std::max(largest, std::abs(static_cast<double>(found.pixels[i]) - whole.pixels[i]));
    // The samples are the same, at other places of a texture.
    constexpr double kRounding = 1e-4;
    addMeasurement(result, largest, kRounding, found.pixels.size() / 4,
                   "voxels " + std::to_string(first.x()) + ", " + std::to_string(first.y()) + ", " +
                       std::to_string(first.z()) + " to " + std::to_string(last.x()) + ", " + std::to_string(last.y()) +
                       ", " + std::to_string(last.z()) + ", slabs of " + spacing + " voxels");
  }
}

}  // namespace umbrick
