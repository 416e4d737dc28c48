// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/grid_world.h"

#include "umbrick/core/error.h"
#include "umbrick/core/patient_space.h"
#include "umbrick/grid/affine_matrix.h"

namespace umbrick {
namespace {

using openvdb::FloatGrid;
using openvdb::StringMetadata;

std::string stated(const openvdb::GridBase& grid, const char* key) {
  const auto text = grid.getMetadata<StringMetadata>(key);
  return text ? text->value() : std::string();
}

}  // namespace

World worldOf(const openvdb::GridBase& grid) {
  return {stated(grid, "space"), stated(grid, "length_unit"), "that of grid \"" + grid.getName() + '"'};
}

FloatGrid::ConstPtr inWorld(const FloatGrid::ConstPtr& grid, const World& world, std::vector<std::string>& notes) {
  const World from = worldOf(*grid);
  const std::size_t before = notes.size();
  const glm::dmat4 change = worldChange(from, world, notes);
  if (notes.size() == before) return grid;
  const auto transform = grid->transform().copy();
  transform->postMult(rowMatrix(change));
  openvdb::MetaMap metadata(*grid);
  if (changeOfSpace(from.space, world.space)) metadata.insertMeta("space", StringMetadata(world.space));
  if (!from.lengthUnit.empty() && !world.lengthUnit.empty())
    metadata.insertMeta("length_unit", StringMetadata(world.lengthUnit));
  return grid->copyReplacingMetadataAndTransform(metadata, transform);
}

FloatGrid::ConstPtr inSpace(const FloatGrid::ConstPtr& grid, const std::string& space,
                            std::vector<std::string>& notes) {
  if (space.empty() || space == "file") return grid;
  if (!patientAxes(space))
    throw InvalidArgument("grid \"" + grid->getName() +
                          "\": space: expected three letters such as LPS or RAS, or file, found " + space);
  const World own = worldOf(*grid);
  if (patientAxes(own.space)) return inWorld(grid, {space, {}, {}}, notes);
  notes.push_back("the grid does not say which way its axes point: they are taken for " + space);
  openvdb::MetaMap metadata(*grid);
  metadata.insertMeta("space", StringMetadata(space));
  return grid->copyReplacingMetadata(metadata);
}

}  // namespace umbrick
