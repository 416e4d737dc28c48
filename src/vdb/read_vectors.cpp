// SPDX-License-Identifier: Apache-2.0
#include "umbrick/vdb/read_vectors.h"

#include <openvdb/tree/LeafManager.h>

#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "vdb/vdb_file.h"

namespace umbrick {
namespace {

float numberOf(const openvdb::Vec3f& value, std::optional<int> component) {
  return component ? value[*component] : value.length();
}

}  // namespace

openvdb::Vec3SGrid::Ptr readVectorGrid(const std::filesystem::path& path, const std::string& selector,
                                       const std::function<void(double share)>& progress) {
  VdbFile file(path);
  const VdbFile::Entry* entry = file.find(selector);
  if (!entry) throw InvalidArgument(path.string() + ": no grid \"" + selector + '"');
  if (entry->valueType != "vec3s" && entry->valueType != "vec3d" && entry->valueType != "vec3i")
    throw InvalidArgument(path.string() + ": grid \"" + entry->label + "\": expected a grid of vec3, found " +
                          entry->valueType);
  const openvdb::GridBase::Ptr any = file.read(*entry, progress);
  if (const auto already = openvdb::gridPtrCast<openvdb::Vec3SGrid>(any)) return already;
  openvdb::Vec3SGrid::Ptr out;
  any->apply<openvdb::TypeList<openvdb::Vec3DGrid, openvdb::Vec3IGrid>>([&](const auto& grid) {
    out = openvdb::Vec3SGrid::create(std::make_shared<openvdb::Vec3STree>(grid.tree()));
    out->insertMeta(grid);
    out->setTransform(grid.transform().copy());
  });
  if (!out) throw IoError(path.string() + ": grid \"" + entry->label + "\": its voxels are not read");
  return out;
}

ScalarGrid vectorComponent(const openvdb::Vec3SGrid& grid, std::optional<int> component) {
  if (component && (*component < 0 || *component > 2))
    throw InvalidArgument("grid \"" + grid.getName() + "\": component: expected 0 to 2, found " +
                          std::to_string(*component));
  if (!grid.transform().isLinear())
    throw InvalidArgument("grid \"" + grid.getName() + "\": expected an affine transform, found " +
                          grid.transform().mapType());
  const auto tree = std::make_shared<openvdb::FloatTree>(grid.tree(), numberOf(grid.background(), component),
                                                         openvdb::TopologyCopy());
  openvdb::tree::LeafManager<openvdb::FloatTree> leaves(*tree);
  leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    const auto* from = grid.tree().probeConstLeaf(leaf.origin());
    for (openvdb::Index i = 0; i < openvdb::FloatTree::LeafNodeType::SIZE; ++i)
      leaf.setValueOnly(i, numberOf(from->getValue(i), component));
  });
  const auto access = grid.getConstAccessor();
  auto tile = tree->beginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) tile.setValue(numberOf(access.getValue(tile.getCoord()), component));
  const auto out = openvdb::FloatGrid::create(tree);
  out->insertMeta(grid);
  out->setTransform(grid.transform().copy());
  out->setGridClass(openvdb::GRID_FOG_VOLUME);
  return {out, grid.getName(), 0};
}

}  // namespace umbrick
