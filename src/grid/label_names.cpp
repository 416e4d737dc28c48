// SPDX-License-Identifier: Apache-2.0
#include "grid/label_names.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "grid/empty_grid.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::size_t kMostLabels = 4096;

std::string namesOf(const VolumeInfo& info) {
  constexpr std::size_t kMostNamed = 20;
  std::string names;
  for (std::size_t i = 0; i < std::min(info.labels.size(), kMostNamed); ++i)
    names += (i == 0 ? "" : ", ") + info.labels[i].name;
  if (info.labels.size() > kMostNamed) names += ", ...";
  return names.empty() ? "(the file has none)" : names;
}

// The labels with what the file says of each.
VolumeLabel describedLabel(const VolumeInfo& info, const LabelKey& key) {
  for (const VolumeLabel& label : info.labels)
    if (label.component == key.first && label.value == key.second) return label;
  VolumeLabel label;
  label.component = key.first;
  label.value = key.second;
  return label;
}

std::string gridNameOf(const VolumeLabel& label) {
  if (!label.name.empty()) return label.name;
  const std::string layer = label.component > 0 ? "layer_" + std::to_string(label.component) + "_" : "";
  return layer + "label_" + std::to_string(label.value);
}

void nameGrid(const VolumeLabel& label, const std::string& name, openvdb::FloatGrid& grid) {
  grid.setName(name);
  grid.insertMeta("label_value", openvdb::Int64Metadata(label.value));
  if (!label.name.empty()) grid.insertMeta("label_name", openvdb::StringMetadata(label.name));
  if (!label.colour) return;
  const glm::dvec3& c = *label.colour;
  grid.insertMeta("label_colour", openvdb::Vec3DMetadata({c.x, c.y, c.z}));
}

// In the order of the file, then by layer and value.
std::vector<LabelKey> orderOf(const VolumeInfo& info, const std::map<LabelKey, LabelGrid>& found) {
  std::vector<LabelKey> order;
  std::set<LabelKey> seen;
  for (const VolumeLabel& label : info.labels)
    if (const LabelKey key{label.component, label.value}; found.contains(key) && seen.insert(key).second)
      order.push_back(key);
  for (const auto& [key, grid] : found)
    if (!seen.contains(key)) order.push_back(key);
  return order;
}

// Counts what a grid holds.
void describeGrid(const VolumeInfo& info, LabelGrid& label) {
  openvdb::tools::prune(label.grid->tree());
  label.report.voxels = voxelsIn(info);
  label.report.activeVoxels = label.grid->activeVoxelCount();
  label.report.activeTiles = label.grid->tree().activeTileCount();
  label.report.leaves = label.grid->tree().leafCount();
  label.report.storage = "float, the share of the label";
}

}  // namespace

WantedLabels::WantedLabels(const VolumeInfo& info, const LabelChoice& choice) : all_(choice.wanted.empty()) {
  for (const std::string& text : choice.wanted) {
    const auto named = [&](const VolumeLabel& label) { return label.name == text; };
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    if (std::any_of(info.labels.begin(), info.labels.end(), named)) {
      for (const VolumeLabel& label : info.labels)
        if (named(label)) keys_.insert({label.component, label.value});
    } else if (std::from_chars(text.data(), end, value).ptr == end && !text.empty()) {
      values_.insert(value);
    } else {
      throw InvalidArgument(info.name + ": label " + text + ": expected a value, or one of the names " + namesOf(info));
    }
  }
  if (values_.contains(0)) throw InvalidArgument(info.name + ": label 0 is the background");
}

void WantedLabels::checkFound(const VolumeInfo& info, const std::map<LabelKey, LabelGrid>& found) const {
  for (const std::int64_t value : values_)
    if (std::none_of(found.begin(), found.end(), [&](const auto& each) { return each.first.second == value; }))
      throw InvalidArgument(info.name + ": label " + std::to_string(value) + ": no voxel has it");
  for (const LabelKey& key : keys_)
    if (!found.contains(key))
      throw InvalidArgument(info.name + ": label " + std::to_string(key.second) + ": no voxel has it");
}

LabelGrids WantedLabels::collect(const VolumeInfo& info, std::map<LabelKey, LabelGrid> found) const {
  checkFound(info, found);
  LabelGrids out;
  std::set<std::string> names;
  for (const LabelKey& key : orderOf(info, found)) {
    LabelGrid label = std::move(found.at(key));
    label.label = describedLabel(info, key);
    const std::string name = gridNameOf(label.label);
    std::string own = name;
    for (int number = 2; !names.insert(own).second; ++number) own = name + "_" + std::to_string(number);
    if (own != name) out.notes.push_back("a second label is called " + name + ": its grid is called " + own);
    nameGrid(label.label, own, *label.grid);
    describeGrid(info, label);
    out.grids.push_back(std::move(label));
  }
  std::string empty;
  for (const VolumeLabel& label : info.labels)
    if (const LabelKey key{label.component, label.value}; contains(key) && !found.contains(key))
      empty += (empty.empty() ? "" : ", ") + gridNameOf(label);
  if (!empty.empty()) out.notes.push_back("labels without a voxel, which become no grid: " + empty);
  return out;
}

LabelGrid& labelGrid(const VolumeInfo& info, const LabelKey& key, std::map<LabelKey, LabelGrid>& found) {
  LabelGrid& label = found[key];
  if (label.grid) return label;
  if (found.size() > kMostLabels)
    throw InvalidArgument(info.name + ": expected at most " + std::to_string(kMostLabels) + " labels, found more");
  label.grid = openvdb::FloatGrid::create(0.0f);
  placeVolumeGrid(info, "", *label.grid);
  return label;
}

std::map<LabelKey, std::size_t> placesOf(const std::vector<VolumeLabel>& labels) {
  std::map<LabelKey, std::size_t> places;
  for (std::size_t i = 0; i < labels.size(); ++i) places[{labels[i].component, labels[i].value}] = i;
  return places;
}

std::uint64_t voxelsIn(const VolumeInfo& info) {
  return static_cast<std::uint64_t>(info.dims.x * info.dims.y) * static_cast<std::uint64_t>(info.dims.z);
}

}  // namespace umbrick
