// The loops over rows: against double precision, and that all sets of instructions agree.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/row_kernels.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/baseline_instructions.h"
#include "support/test_grids.h"
#include "sweep/packet_kernels.h"
#include "umbrick/core/instructions.h"

using namespace umbrick;

namespace {

// Runs with the best instructions and with those of the least machine.
template <class Work>
void forBothInstructions(const Work& work) {
  for (const bool baseline : {false, true}) {
    useBaselineInstructions(baseline);
    INFO("instructions " << cpuInstructions());
    work();
  }
  useBaselineInstructions(false);
}

template <class Code>
void checkBlend(VoxelCode code, double most) {
  TestRandom random(7);
  for (const int count : {1, 15, 16, 17, 40}) {
    std::vector<std::vector<Code>> rows(4, std::vector<Code>(3 * 64));
    for (auto& row : rows)
      for (Code& voxel : row) voxel = static_cast<Code>(random.uniform(0, most));
    for (const std::ptrdiff_t stride : {1, 3})
      for (const float shareN : {0.0f, 0.25f}) {
        VoxelRows from;
        from.stride = stride;
        for (std::size_t i = 0; i < 4; ++i) from.rows[i] = rows[i].data();
        from.v = 0.7f;
        from.n = shareN;
        from.bias = 3;
        from.factor = 0.5f;
        from.first = 2;
        std::vector<float> out(static_cast<std::size_t>(count) + kRowPadding);
        blendRows(code, from, count, out.data());
        for (int i = 0; i < count; ++i) {
          const auto at = static_cast<std::size_t>(i * stride);
          const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
          const double value = mix(mix(rows[0][at], rows[1][at], 0.7f), mix(rows[2][at], rows[3][at], 0.7f), shareN);
          CHECK(out[static_cast<std::size_t>(i)] == Approx((value - 3) * 0.5 + 2).epsilon(1e-5).margin(1e-5 * most));
        }
      }
  }
}

// A row of rays with all that the loops need.
struct Rays {
  explicit Rays(int groups, float length)
      : count(groups * kRayGroup),
        colour(4, std::vector<float>(static_cast<std::size_t>(count))),
        seen(static_cast<std::size_t>(count)),
        depth(seen),
        lengths(static_cast<std::size_t>(count), length),
        enter(static_cast<std::size_t>(count), -1),
        leave(static_cast<std::size_t>(count), 1e6f),
        full(static_cast<std::size_t>(groups)) {}
  RowRays rays() {
    return {colour[0].data(), colour[1].data(), colour[2].data(), colour[3].data(), seen.data(),
            depth.data(),     lengths.data(),   enter.data(),     leave.data(),     full.data()};
  }
  int count;
  std::vector<std::vector<float>> colour;
  std::vector<float> seen, depth, lengths, enter, leave;
  std::vector<std::uint8_t> full;
};

}  // namespace

TEST_CASE("Rows of voxels are interpolated, whatever their type and their distance in memory", "[sweep]") {
  forBothInstructions([] {
    checkBlend<std::uint8_t>(VoxelCode::u8, 255);
    checkBlend<std::uint16_t>(VoxelCode::u16, 65535);
    checkBlend<float>(VoxelCode::f32, 1000);
  });
}

// All but infinite ones and NaN, those below 2^-14 too.
TEST_CASE("Voxels of 16-bit floats are themselves to the last bit", "[sweep]") {
  std::vector<HalfCode> codes;
  std::vector<float> values;
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    if ((bits & 0x7c00) == 0x7c00) continue;
    codes.push_back({static_cast<std::uint16_t>(bits)});
    const double size = bits & 0x7c00 ? std::ldexp(1024 + (bits & 0x3ff), static_cast<int>(bits >> 10 & 31) - 25)
                                      : std::ldexp(bits & 0x3ff, -24);
    values.push_back(static_cast<float>(bits & 0x8000 ? -size : size));
  }
  const auto count = static_cast<int>(codes.size());
  codes.resize(codes.size() + kRowPadding);
  forBothInstructions([&] {
    VoxelRows from;
    from.rows = {codes.data(), codes.data(), codes.data(), codes.data()};
    std::vector<float> out(codes.size());
    blendRows(VoxelCode::f16, from, count, out.data());
    CHECK(std::equal(values.begin(), values.end(), out.begin()));
    // The same as rays gather them, and along another axis.
    for (const std::ptrdiff_t stride : {1, 3}) {
      PacketSlice slice;
      slice.code = VoxelCode::f16;
      slice.strideU = stride;
      slice.strideV = 0;
      bool equal = true;
      for (int at = 0; at + kRayGroup < count / stride; at += kRayGroup) {
        PacketBrick brick;
        brick.voxels = codes.data();
        brick.first = at * stride;
        brick.endU = brick.endV = kRayGroup;
        std::array<float, kRayGroup> u{}, v{}, value{};
        for (int i = 0; i < kRayGroup; ++i) u[static_cast<std::size_t>(i)] = static_cast<float>(i);
        std::array<float*, kMostFields> fields{value.data()};
        samplePacket(slice, {&brick, 1}, u.data(), v.data(), fields.data());
        for (int i = 0; i < kRayGroup; ++i)
          equal = equal && value[static_cast<std::size_t>(i)] == values[static_cast<std::size_t>((at + i) * stride)];
      }
      CHECK(equal);
    }
  });
}

TEST_CASE("Equal voxels give their value to the last bit", "[sweep]") {
  forBothInstructions([] {
    const std::vector<std::uint16_t> row(64, 1023);
    VoxelRows from;
    from.rows = {row.data(), row.data(), row.data(), row.data()};
    from.v = 0.3f;
    from.n = 0.9f;
    std::vector<float> out(32 + kRowPadding);
    blendRows(VoxelCode::u16, from, 32, out.data());
    for (int i = 0; i < 32; ++i) CHECK(out[static_cast<std::size_t>(i)] == 1023);
  });
}

TEST_CASE("Rays find their place in a row, near or far apart, and its ends beyond it", "[sweep]") {
  constexpr int kLength = 50;
  std::vector<float> row(kLength + 2 * kRowPadding, -1e6f);
  for (int i = 0; i < kLength; ++i) row[static_cast<std::size_t>(i)] = static_cast<float>(i * i);
  forBothInstructions([&] {
    for (const double spacing : {0.0, 0.03, 0.5, 0.97, 1.0, 1.7, 2.6})
      for (const double x0 : {100.0, 100.25, 103.9}) {
        INFO("spacing " << spacing << ", from " << x0);
        std::vector<float> out(32);
        float* to = out.data();
        const float* from = row.data();
        sampleRows({x0, spacing, 100}, 0, 32, kLength, 1, &from, &to);
        for (int i = 0; i < 32; ++i) {
          const double x = x0 - 100 + i * spacing;
          if (x > kLength - 1) continue;
          const double whole = std::floor(x), share = x - whole;
          const double expected = whole * whole + share * ((whole + 1) * (whole + 1) - whole * whole);
          // A place is known to 2^-20 of a voxel, over which values change by up to 100 units.
          CHECK(out[static_cast<std::size_t>(i)] == Approx(expected).margin(2e-4));
        }
      }
  });
}

TEST_CASE("A segment of constant medium has the closed form, thin or thick", "[sweep]") {
  forBothInstructions([] {
    for (const double tau : {1e-8, 1e-4, 0.3, 0.49, 0.51, 2.0, 60.0, 1e4}) {
      INFO("optical depth " << tau);
      const TransferFunction transfer({{0, {{0.5, 0.25, 1}, tau / 3}}});
      const MediumTable table(transfer, 0, 1e9);
      Rays row(1, 1.5f);
      std::vector<float> front(kRayGroup, 0.4f), back(kRayGroup, 7.0f);
      const float *fronts[kMostFields]{front.data()}, *backs[kMostFields]{back.data()};
      RowSegment segment;
      segment.from = 4;
      segment.to = 6;
      segment.saturation = 1e-3f;
      integrateRows(table, segment, row.rays(), 0, kRayGroup, fronts, backs);
      const double alpha = -std::expm1(-tau);
      for (std::size_t i = 0; i < kRayGroup; ++i) {
        CHECK(row.colour[3][i] == Approx(alpha).epsilon(2e-6));
        CHECK(row.colour[0][i] == Approx(0.5 * alpha).epsilon(3e-6));
        CHECK(row.colour[1][i] == Approx(0.25 * alpha).epsilon(3e-6));
        CHECK(row.depth[i] == Approx(5 * alpha).epsilon(3e-6));
        CHECK(row.seen[i] == Approx(alpha).epsilon(3e-6));
      }
      CHECK(bool(row.full[0]) == (alpha >= 1 - 1e-3));
    }
  });
}

TEST_CASE("A value that runs through a peak meets all of it", "[sweep]") {
  // A triangle of height 2 over a fiftieth of the way.
  const TransferFunction transfer({{0, {glm::dvec3(1), 0}},
                                   {49, {glm::dvec3(1), 0}},
                                   {50, {glm::dvec3(1), 2}},
                                   {51, {glm::dvec3(1), 0}},
                                   {100, {glm::dvec3(1), 0}}});
  const MediumTable table(transfer, 0, 1e9);
  forBothInstructions([&] {
    Rays row(1, 1);
    std::vector<float> front(kRayGroup, static_cast<float>(table.stepsOf(10))),
        back(kRayGroup, static_cast<float>(table.stepsOf(90)));
    const float *fronts[kMostFields]{front.data()}, *backs[kMostFields]{back.data()};
    RowSegment segment;
    segment.to = 1;
    integrateRows(table, segment, row.rays(), 0, kRayGroup, fronts, backs);
    // The area of the peak is 2 units of value, of 80. A step of the table is 1 / 41 of a unit.
    CHECK(row.colour[3][0] == Approx(-std::expm1(-2.0 / 80)).epsilon(1e-3));
  });
}

// Against a march in double precision. Most of the way is empty; then colours change within a thousandth of it, and
// the last is opaque.
TEST_CASE("Colours that hide each other within a part of a segment are integrated exactly", "[sweep]") {
  const TransferFunction transfer({{0, {{1, 0, 0}, 0.1}},
                                   {500, {{1, 0, 0.2}, 0.2}},
                                   {500, {{0, 1, 0.1}, 4}},
                                   {500.2, {{0.2, 0.3, 1}, 2e4}},
                                   {700, {{0.1, 0.1, 0.4}, 2e4}},
                                   {1000, {{0.9, 0.9, 0.9}, 1e3}}});
  const MediumTable table(transfer, 0, 1e9, 10);
  REQUIRE(table.stretches());
  forBothInstructions([&] {
    for (const auto& [from, to] : {std::pair{100.0, 900.0}, {900.0, 100.0}, {499.9, 500.13}, {-300.0, 501.0}}) {
      Rays row(1, 1.5f);
      std::vector<float> front(kRayGroup, static_cast<float>(table.stepsOf(from))),
          back(kRayGroup, static_cast<float>(table.stepsOf(to)));
      const float *fronts[kMostFields]{front.data()}, *backs[kMostFields]{back.data()};
      RowSegment segment;
      segment.to = 1;
      integrateRows(table, segment, row.rays(), 0, kRayGroup, fronts, backs);
      glm::dvec3 exact(0);
      double through = 1;
      constexpr int kParts = 400000;
      for (int i = 0; i < kParts; ++i) {
        const Medium medium = transfer(from + (i + 0.5) / kParts * (to - from));
        const double kept = std::exp(-medium.sigma_t * 1.5 / kParts);
        exact += through * (1 - kept) * medium.albedo;
        through *= kept;
      }
      INFO("from " << from << " to " << to);
      // A stretch's colour is off by up to 0.009 of its change; a value by a 250th of a step of the table, of which the
      // steep stretch has some ten.
      for (int c = 0; c < 3; ++c) CHECK(row.colour[static_cast<std::size_t>(c)][5] == Approx(exact[c]).margin(8e-3));
      CHECK(row.colour[3][5] == Approx(1 - through).margin(1e-3));
    }
  });
}

TEST_CASE("Only functions with colours that hide each other have stretches", "[sweep]") {
  const auto tableOf = [](const Medium& low, const Medium& high) {
    return MediumTable(TransferFunction({{0, low}, {1, high}}), 0, 1e9, 10);
  };
  CHECK(tableOf({{1, 0, 0}, 0.5}, {{0, 1, 0}, 20}).stretches());
  CHECK_FALSE(tableOf({{1, 0, 0}, 0.5}, {{0, 1, 0}, 9}).stretches());
  CHECK_FALSE(tableOf({{0, 1, 0}, 0.5}, {{0, 1, 0}, 20}).stretches());
  // Colours go over into each other where extinction begins.
  CHECK(tableOf({{1, 0, 0}, 0}, {{0, 1, 0}, 20}).stretches());
}

TEST_CASE("A faint medium keeps its extinction beside one a million times as dense", "[sweep]") {
  const TransferFunction transfer({{0, {glm::dvec3(1), 0.02}},
                                   {1200, {glm::dvec3(1), 0.02}},
                                   {1200.05, {glm::dvec3(1), 20000}},
                                   {3000, {glm::dvec3(1), 20000}}});
  const MediumTable table(transfer, 0, 1e9);
  REQUIRE(table.rests());
  forBothInstructions([&] {
    for (const double change : {0.3, 3.0, 40.0}) {
      Rays row(1, 10);
      std::vector<float> front(kRayGroup, static_cast<float>(table.stepsOf(500))),
          back(kRayGroup, static_cast<float>(table.stepsOf(500 + change)));
      const float *fronts[kMostFields]{front.data()}, *backs[kMostFields]{back.data()};
      RowSegment segment;
      segment.to = 1;
      integrateRows(table, segment, row.rays(), 0, kRayGroup, fronts, backs);
      CHECK(row.colour[3][0] == Approx(-std::expm1(-0.2)).epsilon(1e-3));
    }
  });
}

TEST_CASE("Planes leave a part of a segment, and light is that of its middle", "[sweep]") {
  const TransferFunction transfer({{0, {glm::dvec3(1), 0}}, {100, {glm::dvec3(1), 1}}});
  const MediumTable table(transfer, 0, 1e9);
  forBothInstructions([&] {
    Rays row(1, 2);
    row.enter.assign(kRayGroup, 10.25f);
    row.leave.assign(kRayGroup, 10.75f);
    std::vector<float> front(kRayGroup, static_cast<float>(table.stepsOf(20))),
        back(kRayGroup, static_cast<float>(table.stepsOf(60)));
    std::vector<float> dark(kRayGroup, 0.2f), bright(kRayGroup, 0.6f);
    const float *fronts[kMostFields]{front.data(), nullptr, dark.data()},
        *backs[kMostFields]{back.data(), nullptr, bright.data()};
    RowSegment segment;
    segment.from = 10;
    segment.to = 11;
    segment.clipped = true;
    segment.lights = 1;
    integrateRows(table, segment, row.rays(), 0, kRayGroup, fronts, backs);
    // Between values 30 and 50, over half of a segment of length 2. It is taken in four parts, so that light is known
    // at their middles.
    const double alpha = -std::expm1(-0.4);
    CHECK(row.colour[3][3] == Approx(alpha).epsilon(1e-4));
    CHECK(row.colour[0][3] == Approx(0.4 * alpha).epsilon(2e-2));
  });
}

TEST_CASE("All sets of instructions give the same picture of a row", "[sweep]") {
  TestRandom random(31);
  const TransferFunction transfer(
      {{0, {{1, 0.2, 0.1}, 0}}, {30, {{0.4, 0.9, 0.3}, 3}}, {31, {{1, 1, 1}, 0.1}}, {100, {{0.3, 0.3, 1}, 8}}});
  const MediumTable table(transfer, 0, 1e9);
  constexpr int kGroups = 5, kSlices = 40;
  std::vector<std::vector<float>> values(kSlices + 1, std::vector<float>(kGroups * kRayGroup));
  for (auto& slice : values)
    for (float& value : slice) value = static_cast<float>(table.stepsOf(random.uniform(-20, 120)));
  std::vector<std::vector<float>> results;
  forBothInstructions([&] {
    Rays row(kGroups, 0.05f);
    for (int slice = 0; slice < kSlices; ++slice) {
      const float *fronts[kMostFields]{values[static_cast<std::size_t>(slice)].data()},
          *backs[kMostFields]{values[static_cast<std::size_t>(slice) + 1].data()};
      RowSegment segment;
      segment.from = static_cast<float>(slice);
      segment.to = static_cast<float>(slice + 1);
      integrateRows(table, segment, row.rays(), 0, row.count, fronts, backs);
    }
    for (const auto& channel : row.colour) results.push_back(channel);
  });
  REQUIRE(results.size() == 8);
  // Machines with a fused multiply-add round once less, 40 times.
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i < results[c].size(); ++i)
      CHECK(std::abs(results[c][i] - results[c + 4][i]) < 40 * 1.2e-7f);
}
