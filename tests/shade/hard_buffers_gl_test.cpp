// Hard cases of the buffers: very many slices, 16 bits, and next to nothing per slice. Tested elsewhere: opacities of a
// slab from 1e-6 to 1e3 (emission_gl_test), 16-bit occlusion of some 30 slabs (occlusion_gl_test), the cost of 16 bits
// on a scan (README).
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "shade/shade_fixture.h"

using namespace umbrick;

namespace {

const double kStep = std::exp2(-16);  // step of a 16-bit buffer

// A block of depth `kDepth` is seen face-on, and the sweep cuts it into `slices` slabs of opacity 1 - exp(-tau) each.
// The eye is as far in front of the block as a slab is thick: slices lie in the block from the second on.
constexpr double kDepth = 20;

struct Sweep {
  ResolvedScene scene;
  int slices;
  double tau;  // optical depth of a slab
  Picture render(const GlContext& context) const {
    const FieldBricks volume = fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-8), glm::ivec3(31)});
    return renderPicture(context, volume, scene, {.visibilityAndDepth = true});
  }
};

Sweep makeSweep(Model model, int slices, double tau) {
  const double d = kDepth / slices, top = 20.5;
  const Medium medium{{1, 0.5, 0.25}, tau / d};
  Sweep sweep{plainScene(TransferFunction({{0, {medium.albedo, 0}}, {1, medium}}),
                         orthographicCamera({12, 12, top + d}, {12, 12, 0}, 8, 8), d),
              slices, tau};
  sweep.scene.model = model;
  sweep.scene.occlusion.dos.footprint = 2;
  sweep.scene.clipBox = Box{glm::dvec3(-4, -4, top - kDepth), glm::dvec3(28, 28, top)};
  return sweep;
}

// The sums that the equations of SliceRenderer give for such slabs: opacity and its product with V.
struct Series {
  double alpha = 0, visibility = 0;
  explicit Series(const Sweep& sweep) {
    double light = 1;
    for (int i = 0; i < sweep.slices; ++i) {
      const double share = (1 - alpha) * -std::expm1(-sweep.tau);
      alpha += share;
      visibility += share * light;
      if (sweep.scene.model == Model::cone) light *= std::exp(-sweep.tau);
    }
  }
};

// Returns a bound of rounding. Every slab rounds the buffers a few times in single precision, at worst each time the
// same way. The first and the last one are cut by the box, whose faces single precision places to 1e-6 of a slab.
double floatBound(const Sweep& sweep) { return 4 * kFloatRounding * sweep.slices + 2e-6 * sweep.tau; }

}  // namespace

TEST_CASE("A sweep of 10 000 slices adds up to that of 100", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const double whole : {1e-3, 0.5, 2.3}) {
    const Sweep few = makeSweep(Model::emission, 100, whole / 100);
    const Sweep many = makeSweep(Model::emission, 10'000, whole / 10'000);
    const Picture coarse = few.render(*context), fine = many.render(*context);
    REQUIRE(fine.stats.slices >= 10'000);
    const double difference = maxDifference(coarse.colour, fine.colour);
    INFO("optical depth " << whole << ", difference " << difference);
    CHECK(difference < floatBound(few) + floatBound(many));
    CHECK(std::abs(fine.colour.at(4, 4)[3] + std::expm1(-whole)) < floatBound(many));
  }
}

TEST_CASE("Light that 10 000 slices have carried is that of the equations", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const double whole : {0.05, 2.3})
    for (const int slices : {100, 10'000}) {
      const Sweep sweep = makeSweep(Model::cone, slices, whole / slices);
      const Picture picture = sweep.render(*context);
      const Series exact(sweep);
      INFO("optical depth " << whole << ", slices " << slices << ": " << picture.visibility.at(4, 4)[0] << " for "
                            << exact.visibility);
      CHECK(std::abs(picture.visibility.at(4, 4)[0] - exact.visibility) < floatBound(sweep));
      CHECK(std::abs(picture.colour.at(4, 4)[1] - 0.5 * exact.visibility) < floatBound(sweep));
    }
}

// The bound is that of SamplingOptions::bits. A slab's light, opacity and transmittance are rounded, and what is
// blended is rounded again: an error of half a step each time. Where roundings go up as often as down they add up as a
// random walk, to sqrt(N) steps.
TEST_CASE("16 bits stay within a step and a half per slice", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const Model model : {Model::emission, Model::cone})
    for (const double whole : {0.05, 2.3})
      for (const int slices : {100, 10'000}) {
        Sweep sweep = makeSweep(model, slices, whole / slices);
        const Series exact(sweep);
        const double bound = 1.5 * kStep * slices;
        const auto check = [&](int eyeBits, int occlusionBits, double allowed) {
          sweep.scene.sampling.bits = eyeBits;
          sweep.scene.occlusion.bits = occlusionBits;
          const Picture picture = sweep.render(*context);
          const double alpha = picture.colour.at(4, 4)[3], red = picture.colour.at(4, 4)[0];
          INFO("cone " << (model == Model::cone) << ", optical depth " << whole << ", slices " << slices << ", bits "
                       << eyeBits << " and " << occlusionBits << ": alpha " << alpha << " for " << exact.alpha
                       << ", red " << red << " for " << exact.visibility);
          CHECK(std::abs(alpha - exact.alpha) < (eyeBits == 16 ? bound : 0) + floatBound(sweep));
          CHECK(std::abs(red - exact.visibility) < allowed + floatBound(sweep));
        };
        check(16, 32, bound);
        if (model == Model::cone) check(32, 16, bound);
        if (model == Model::cone) check(16, 16, 2 * bound);
      }
}

// Where 1 - A times the opacity of a slab is less than half a step, it is rounded to nothing.
TEST_CASE("A 16-bit sum stops growing at 1 - 2^-17 over the opacity of a slab", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const auto alphaOf = [&](int bits, double slab, int slices) {
    Sweep sweep = makeSweep(Model::emission, slices, -std::log1p(-slab));
    sweep.scene.sampling.bits = bits;
    return static_cast<double>(sweep.render(*context).colour.at(4, 4)[3]);
  };
  const int slices = 10'000;
  // Long before its end this sum stops at 1 - 1/64, though 0.8 % more are to come. A half-float stops where its own
  // steps exceed what a slab adds: above 1/2 they are 2^-11, so a sum that is truncated stops there.
  const double slab = std::exp2(-11), stop = 1 - std::exp2(-17) / slab;
  CHECK(std::abs(alphaOf(16, slab, slices) - stop) < 1.5 * kStep);
  CHECK(std::abs(alphaOf(16, slab, slices + 2000) - stop) < 1.5 * kStep);
  CHECK(std::abs(alphaOf(32, slab, slices) - (1 - std::pow(1 - slab, slices))) < 4 * kFloatRounding * slices);
  // Half a step is the least that counts in 16 bits; 32 bits hold less.
  CHECK(alphaOf(16, 0.45 * kStep, slices) == 0);
  CHECK(alphaOf(32, 0.45 * kStep, slices) == Approx(-std::expm1(slices * std::log1p(-0.45 * kStep))).epsilon(1e-3));
  CHECK(alphaOf(16, 1.55 * kStep, 1000) > 500 * kStep);
}
