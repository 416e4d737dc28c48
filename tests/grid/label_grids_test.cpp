// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/label_grids.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "support/memory_source.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const glm::i64vec3 kLabelDims(21, 10, 26);

// Labels in blocks of random edges, some of which fill leaves.
std::vector<float> labelVoxels() {
  std::mt19937 random(5);
  std::vector<float> out(static_cast<std::size_t>(kLabelDims.x * kLabelDims.y * kLabelDims.z), 0.0f);
  for (std::int64_t z = 0; z < kLabelDims.z; ++z)
    for (std::int64_t y = 0; y < kLabelDims.y; ++y)
      for (std::int64_t x = 0; x < kLabelDims.x; ++x) {
        float& label = out[static_cast<std::size_t>((z * kLabelDims.y + y) * kLabelDims.x + x)];
        if (x < 8 && y < 8 && z < 8)
          label = 300;  // a whole leaf
        else if (z > 12)
          label = static_cast<float>(random() % 6);
      }
  return out;
}

std::vector<openvdb::FloatGrid::ConstPtr> gridsOf(const LabelGrids& labels) {
  std::vector<openvdb::FloatGrid::ConstPtr> out;
  for (const LabelGrid& label : labels.grids) out.push_back(label.grid);
  return out;
}

std::vector<VolumeLabel> labelsOf(const LabelGrids& labels) {
  std::vector<VolumeLabel> out;
  for (const LabelGrid& label : labels.grids) out.push_back(label.label);
  return out;
}

}  // namespace

TEST_CASE("Each label becomes a grid of its own voxels, and background none", "[grid]") {
  const std::vector<float> voxels = labelVoxels();
  MemorySource source(kLabelDims, voxels), again(kLabelDims, voxels);
  const LabelGrids labels = buildLabelGrids(source);
  std::map<std::string, openvdb::FloatGrid::Ptr> byName;
  for (const LabelGrid& label : labels.grids) byName[label.grid->getName()] = label.grid;
  CHECK(byName.size() == 6);
  std::size_t wrong = 0;
  for (int z = 0; z < kLabelDims.z; ++z)
    for (int y = 0; y < kLabelDims.y; ++y)
      for (int x = 0; x < kLabelDims.x; ++x) {
        const float label = voxels[static_cast<std::size_t>((z * kLabelDims.y + y) * kLabelDims.x + x)];
        for (const auto& [name, grid] : byName) {
          const bool is = name == "label_" + std::to_string(static_cast<int>(label));
          wrong += grid->tree().isValueOn({x, y, z}) != is || grid->tree().getValue({x, y, z}) != (is ? 1.0f : 0.0f);
        }
      }
  CHECK(wrong == 0);
  CHECK(byName.at("label_300")->tree().activeTileCount() == 1);
  CHECK(byName.at("label_300")->getMetadata<openvdb::Int64Metadata>("label_value")->value() == 300);
  for (const VerifyReport& report : verifyLabelGrids(again, labelsOf(labels), gridsOf(labels)))
    CHECK(report.honours(labels.grids.front().report));
}

TEST_CASE("A comparison of labels finds a voxel that is missing and one too many", "[grid]") {
  const std::vector<float> voxels = labelVoxels();
  MemorySource source(kLabelDims, voxels), again(kLabelDims, voxels);
  const LabelGrids labels = buildLabelGrids(source);
  labels.grids[0].grid->tree().setValueOff(labels.grids[0].grid->tree().cbeginLeaf()->cbeginValueOn().getCoord(), 0.0f);
  labels.grids[1].grid->tree().setValueOn({100, 0, 0}, 1.0f);
  const std::vector<VerifyReport> reports = verifyLabelGrids(again, labelsOf(labels), gridsOf(labels));
  CHECK(reports[0].error.max == 1);
  CHECK(reports[1].beyond == 1);
  CHECK(reports[2].honours(labels.grids[2].report));
}

TEST_CASE("Labels have the names of the file, are picked by them, and equal names are told apart", "[grid]") {
  const std::vector<float> voxels = labelVoxels();
  const auto open = [&] {
    MemorySource source(kLabelDims, voxels);
    source.editInfo().labels = {
        {"bone", 3, 0, {}}, {"liver", 1, 0, glm::dvec3(1, 0.5, 0)}, {"bone", 300, 0, {}}, {"air", 77, 0, {}}};
    return source;
  };
  const auto names = [&](const LabelChoice& choice) {
    MemorySource source = open();
    std::vector<std::string> out;
    for (const LabelGrid& label : buildLabelGrids(source, choice).grids) out.push_back(label.grid->getName());
    return out;
  };
  CHECK(names({}) == std::vector<std::string>{"bone", "liver", "bone_2", "label_2", "label_4", "label_5"});
  CHECK(names({{"liver", "4"}}) == std::vector<std::string>{"liver", "label_4"});
  CHECK(names({{"bone"}}) == std::vector<std::string>{"bone", "bone_2"});
  CHECK_THROWS_WITH(names({{"spleen"}}), Contains("label spleen") && Contains("bone, liver, bone, air"));
  CHECK_THROWS_WITH(names({{"air"}}), Contains("label 77: no voxel has it"));
  CHECK_THROWS_WITH(names({{"9"}}), Contains("label 9: no voxel has it"));
  CHECK_THROWS_WITH(names({{"0"}}), Contains("label 0 is the background"));
  MemorySource source = open();
  const LabelGrids labels = buildLabelGrids(source);
  CHECK(labels.notes == std::vector<std::string>{"a second label is called bone: its grid is called bone_2",
                                                 "labels without a voxel, which become no grid: air"});
  const auto colour = labels.grids[1].grid->getMetadata<openvdb::Vec3DMetadata>("label_colour");
  CHECK(colour->value() == openvdb::Vec3d(1, 0.5, 0));
}

TEST_CASE("Layers of labels may overlap", "[grid]") {
  // Two numbers a voxel: both layers use the value 1.
  std::vector<float> voxels(2 * 4 * 4 * 4, 0.0f);
  voxels[0] = 1, voxels[1] = 1, voxels[3] = 1;
  MemorySource source({4, 4, 4}, voxels);
  source.editInfo().valuesPerVoxel = source.editInfo().components = 2;
  source.editInfo().labels = {{"inner", 1, 1, {}}, {"outer", 1, 0, {}}};
  const LabelGrids labels = buildLabelGrids(source);
  REQUIRE(labels.grids.size() == 2);
  CHECK(labels.grids[0].grid->getName() == "inner");
  CHECK(labels.grids[0].report.activeVoxels == 2);
  CHECK(labels.grids[1].report.activeVoxels == 1);
}

TEST_CASE("Voxels that are no labels are refused", "[grid]") {
  std::vector<float> voxels(8 * 8 * 8, 0.0f);
  voxels[100] = 1.5f;
  MemorySource source({8, 8, 8}, voxels);
  CHECK_THROWS_WITH(buildLabelGrids(source), Contains("memory: expected labels that are integers") && Contains("1.5"));
  std::vector<float> many(64 * 64 * 2);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<float>(i);
  MemorySource tooMany({64, 64, 2}, many);
  CHECK_THROWS_WITH(buildLabelGrids(tooMany), Contains("expected at most 4096 labels"));
}
