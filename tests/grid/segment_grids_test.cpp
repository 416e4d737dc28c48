// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "umbrick/grid/label_grids.h"

using namespace umbrick;

namespace {

// Two segments that overlap, of which the second is fractional.
class TwoSegments : public SegmentSource {
 public:
  TwoSegments() {
    info_.name = "two";
    info_.dims = {9, 8, 10};
    info_.labels = {{"inner", 1, 0, {}}, {"outer", 2, 0, {}}};
    for (std::int64_t z = 0; z < 8; ++z) frames_.push_back({0, z});
    frames_.push_back({1, 3});
    frames_.push_back({1, 9});
    frames_.push_back({1, 9});  // once more, with smaller shares
  }
  void read(std::size_t frame, std::span<float> out) override {
    ++reads;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = frames_[frame].label == 0 ? float(i % 9 < 8) : frame == 10 ? 0.125f : i < 20 ? 0.75f : 0.0f;
  }
  int reads = 0;
};

}  // namespace

TEST_CASE("Segments that overlap become a grid each, with the share of each voxel", "[grid]") {
  TwoSegments source;
  const LabelGrids grids = buildSegmentGrids(source);
  CHECK(source.reads == 11);  // each frame once
  REQUIRE(grids.grids.size() == 2);
  const auto& inner = *grids.grids[0].grid;
  const auto& outer = *grids.grids[1].grid;
  CHECK(inner.getName() == "inner");
  CHECK(inner.activeVoxelCount() == 8 * 8 * 8);
  CHECK(inner.tree().activeTileCount() == 1);  // a whole leaf
  CHECK(outer.activeVoxelCount() == 20 + 72);
  CHECK(outer.tree().getValue({1, 0, 3}) == 0.75f);
  CHECK(outer.tree().getValue({1, 0, 9}) == 0.75f);
  CHECK(outer.tree().getValue({1, 5, 9}) == 0.125f);

  const std::vector<VolumeLabel> labels{grids.grids[0].label, grids.grids[1].label};
  const auto honoured = [&](const openvdb::FloatGrid::ConstPtr& first, const openvdb::FloatGrid::ConstPtr& second) {
    std::vector<bool> out;
    for (const VerifyReport& report : verifySegmentGrids(source, labels, {first, second}))
      out.push_back(report.honours(grids.grids[out.size()].report));
    return out;
  };
  CHECK(honoured(grids.grids[0].grid, grids.grids[1].grid) == std::vector<bool>{true, true});
  const auto less = inner.deepCopy(), more = outer.deepCopy();
  less->tree().setValueOff({0, 0, 0}, 0.0f);
  more->tree().setValueOn({20, 0, 0}, 1.0f);
  CHECK(honoured(less, more) == std::vector<bool>{false, false});
}

TEST_CASE("Frames of segments that are not wanted are not read", "[grid]") {
  TwoSegments source;
  const LabelGrids grids = buildSegmentGrids(source, {{"outer"}});
  CHECK(source.reads == 3);
  REQUIRE(grids.grids.size() == 1);
  CHECK(grids.grids[0].label.value == 2);
}
