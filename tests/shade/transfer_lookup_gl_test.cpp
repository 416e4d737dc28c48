// What can be seen through a transfer function, by the values that bricks hold.
// SPDX-License-Identifier: Apache-2.0
#include "shade/transfer_lookup.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/field_bricks.h"
#include "support/gl_fixture.h"

using namespace umbrick;

namespace {

class OneRange : public Bricks {
 public:
  OneRange(const Range& range, float outside) {
    value = range;
    gradient = {0, 0};
    background = outside;
  }
  void read(const glm::ivec3&, std::span<float>, std::span<float>) const override {}
};

const glm::dvec3 kWhite(1);

}  // namespace

// Empty space must stay as transparent as the function says, however close to the background a medium begins.
TEST_CASE("The background alone is seen as the function has it", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const auto& [low, high, background] :
       {std::tuple(0.0f, 1.0f, 0.0f), std::tuple(-1024.0f, 3071.0f, -1024.0f), std::tuple(-1024.0f, 3071.0f, -1000.0f),
        std::tuple(-7.3f, 2.9f, 0.0f), std::tuple(0.0f, 5.5f, 5.5f), std::tuple(2.0f, 9.0f, 2.001f)})
    for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
      for (const VoxelFormat format : {VoxelFormat::unorm16, VoxelFormat::half, VoxelFormat::float32}) {
        INFO("values " << low << " to " << high << ", background " << background);
        const double b = background, width = 1e-3 * (high - low);
        const TransferFunction valley({{b - width, {kWhite, 1}}, {b, {kWhite, 0}}, {b + width, {kWhite, 1}}});
        SamplingOptions sampling;
        sampling.quadrature = quadrature;
        const TransferLookup lookup(context->gl(), valley, sampling, OneRange({low, high}, background), format);
        CHECK_FALSE(lookup.isVisible({background, background}, {0, 0}));
        CHECK(lookup.isVisible({background, high}, {0, 0}) == (high > background));
        CHECK(lookup.isVisible({low, background}, {0, 0}) == (low < background));
      }
}

TEST_CASE("A range is invisible only where no texel of it is seen, and seen no farther than rounding goes",
          "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const TransferFunction peak({{0.3, {kWhite, 0}}, {0.31, {kWhite, 5}}, {0.32, {kWhite, 0}}});
  for (const VoxelFormat format :
       {VoxelFormat::unorm8, VoxelFormat::unorm16, VoxelFormat::half, VoxelFormat::float32}) {
    const OneRange volume({0, 1}, 0);
    const TransferLookup lookup(context->gl(), peak, SamplingOptions{}, volume, format);
    const double rounding = texelScale(volume, format).rounding;
    const auto visible = [&](double low, double high) {
      return lookup.isVisible({static_cast<float>(low), static_cast<float>(high)}, {0, 0});
    };
    CHECK(visible(0.1, 0.305));
    CHECK(visible(0.315, 0.9));
    // Voxels just beside the peak may be rounded into it.
    CHECK(visible(0.1, 0.3 - 0.5 * rounding + 1e-6));
    CHECK_FALSE(visible(0.1, 0.3 - rounding - 1e-5));
    CHECK_FALSE(visible(0.32 + rounding + 1e-5, 0.9));
  }
}

// Gradients are rounded by half-floats even where values are not.
TEST_CASE("Gradients that half-floats round across a step are not culled", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  OneRange volume({0, 64}, 0);
  volume.exactFormat = VoxelFormat::half;
  volume.hasGradients = true;
  const Medium none{kWhite, 0}, solid{kWhite, 1};
  const TransferFunction byGradient({0}, {1.7322, 1.7322}, {none, solid});
  const TransferLookup lookup(context->gl(), byGradient, SamplingOptions{}, volume, VoxelFormat::half);
  CHECK(lookup.isVisible({0, 64}, {0, 1.73205f}));
  CHECK_FALSE(lookup.isVisible({0, 64}, {0, 1.72f}));
}

TEST_CASE("A function of thousands of points is taken, of more than a texture holds refused", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  std::vector<TransferFunction::Point> points;
  for (int i = 0; i < 9000; ++i) points.push_back({static_cast<double>(i), {kWhite, 1}});
  const TransferLookup many(context->gl(), TransferFunction(points), SamplingOptions{}, OneRange({0, 1}, 0),
                            VoxelFormat::float32);
  CHECK(many.isVisible({5, 6}, {0, 0}));
  for (int i = 9000; i < 100'000; ++i) points.push_back({static_cast<double>(i), {kWhite, 1}});
  CHECK_THROWS_AS(TransferLookup(context->gl(), TransferFunction(points), SamplingOptions{}, OneRange({0, 1}, 0),
                                 VoxelFormat::float32),
                  InvalidArgument);
}
