// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/world.h"

#include <glm/ext/matrix_transform.hpp>
#include <utility>

#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/placed_source.h"
#include "umbrick/core/error.h"
#include "umbrick/core/patient_space.h"

namespace umbrick {
namespace {

std::string stated(const VolumeInfo& info, const char* key) {
  const auto found = info.metadata.find(key);
  return found == info.metadata.end() ? std::string() : found->second;
}

}  // namespace

World worldOf(const VolumeInfo& info) {
  return {stated(info, "space"), stated(info, "length_unit"), "that of " + info.name};
}

World completed(World world, const World& other) {
  if (world.space.empty() && world.lengthUnit.empty()) return other;
  if (world.space.empty()) world.space = other.space;
  if (world.lengthUnit.empty()) world.lengthUnit = other.lengthUnit;
  return world;
}

glm::dmat4 worldChange(const World& from, const World& to, std::vector<std::string>& notes) {
  glm::dmat4 change(1);
  const std::string as = to.of.empty() ? "" : ", " + to.of;
  if (const auto turn = changeOfSpace(from.space, to.space); turn && from.space != to.space) {
    change = *turn;
    notes.push_back("its world is turned from " + from.space + " to " + to.space + as);
  }
  const auto before = millimetresPer(from.lengthUnit), after = millimetresPer(to.lengthUnit);
  if (before && after && *before != *after) {
    change = glm::scale(glm::dmat4(1), glm::dvec3(ratioOfUnits(*before, *after))) * change;
    notes.push_back("its lengths are counted in " + to.lengthUnit + " in place of " + from.lengthUnit + as);
  }
  return change;
}

std::unique_ptr<VoxelSource> inWorld(std::unique_ptr<VoxelSource> source, const World& world, bool assumed) {
  VolumeInfo info = source->info();
  const World from = worldOf(info);
  const std::size_t notes = info.notes.size();
  info.indexToWorld = worldChange(from, world, info.notes) * info.indexToWorld;
  if (const auto turn = changeOfSpace(from.space, world.space))
    info.vectorToWorld = glm::dmat3(*turn) * info.vectorToWorld;
  const bool spaceKnown = patientAxes(from.space).has_value(), unitKnown = millimetresPer(from.lengthUnit).has_value();
  if (patientAxes(world.space) && spaceKnown) info.metadata["space"] = world.space;
  if (millimetresPer(world.lengthUnit) && unitKnown) info.metadata["length_unit"] = world.lengthUnit;
  if (assumed && patientAxes(world.space) && !spaceKnown)
    info.notes.push_back("the file does not say which way its axes point: its place is taken as it is beside " +
                         world.space + ", " + world.of);
  if (assumed && millimetresPer(world.lengthUnit) && !unitKnown)
    info.notes.push_back("the file states no unit of length: its numbers are taken as they are beside " +
                         world.lengthUnit + ", " + world.of);
  if (info.notes.size() == notes) return source;
  return std::make_unique<PlacedSource>(std::move(source), std::move(info));
}

std::unique_ptr<VoxelSource> inSpace(std::unique_ptr<VoxelSource> source, const std::string& space) {
  if (space == "file") return source;
  VolumeInfo info = source->info();
  if (!patientAxes(space))
    throw InvalidArgument(info.name + ": space: expected three letters such as LPS or RAS, or file, found " +
                          shortened(space));
  const std::string own = stated(info, "space");
  if (own == space) return source;
  if (const auto turn = changeOfSpace(own, space)) {
    info.indexToWorld = *turn * info.indexToWorld;
    info.vectorToWorld = glm::dmat3(*turn) * info.vectorToWorld;
    info.notes.push_back("its world is turned from " + own + " to " + space);
  } else if (own.empty()) {
    info.notes.push_back("the file does not say which way its axes point: they are taken for " + space);
  } else {
    throw InvalidArgument(info.name + ": space: cannot turn to " + space + ": the file's own is " + shortened(own) +
                          ", which does not say where left and front are");
  }
  info.metadata["space"] = space;
  return std::make_unique<PlacedSource>(std::move(source), std::move(info));
}

std::unique_ptr<VoxelSource> inLengthUnit(std::unique_ptr<VoxelSource> source, const std::string& unit) {
  VolumeInfo info = source->info();
  changeLengthUnit(info, unit);
  return std::make_unique<PlacedSource>(std::move(source), std::move(info));
}

}  // namespace umbrick
