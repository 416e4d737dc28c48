#include "umbrick/optics/transfer_table.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "support/random_transfer.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {
constexpr glm::dvec3 kMidGrey{0.5};

// The place of a lookup: entry below, entry above and weight of the latter.
struct Tap {
  int lower, upper;
  double weight;
};
Tap tapAt(double value, const Range& range, int nodes) {
  const double u =
      std::clamp((value - range.min) / (static_cast<double>(range.max) - range.min), 0.0, 1.0) * (nodes - 1);
  const int lower = std::min(static_cast<int>(u), nodes - 1);
  // At a node the weight of the next one is 0, so it is not touched.
  return {lower, u > lower ? lower + 1 : lower, u - lower};
}

// What GL_LINEAR returns.
glm::dvec4 lookup(const std::vector<glm::vec4>& entries, int columns, const Tap& x, const Tap& y) {
  const auto at = [&](int i, int j) {
    return glm::dvec4(
        entries[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)]);
  };
  const glm::dvec4 below = glm::mix(at(x.lower, y.lower), at(x.upper, y.lower), x.weight);
  const glm::dvec4 above = glm::mix(at(x.lower, y.upper), at(x.upper, y.upper), x.weight);
  return glm::mix(below, above, y.weight);
}
glm::dvec4 lookup(const TransferTable& table, double value, double gradient = 0) {
  const Tap y = table.rows > 1 ? tapAt(gradient, table.gradient, table.rows) : Tap{0, 0, 0};
  return lookup(table.entries, table.columns, tapAt(value, table.value, table.columns), y);
}

glm::dvec4 coefficients(const Medium& medium) { return {medium.sigma_s(), medium.sigma_t}; }

Range randomRange(std::mt19937& random, float low, float high) {
  const float a = uniform(random, low, high), b = a + uniform(random, 0, 1) * uniform(random, 0, 40);
  return {a, b};
}
}  // namespace

TEST_CASE("Table entries are the associated medium at their nodes", "[optics]") {
  const TransferFunction f({{0, {{1, 0.5, 0}, 0}}, {100, {{0, 0.5, 1}, 8}}});
  const TransferTable table = sampleTransferFunction(f, {0, 400}, {}, 5);
  CHECK(table.value == Range{0, 100});  // the function is constant from 100 on
  for (int i = 0; i < 5; ++i) {
    const Medium medium = f(25.0 * i);
    CHECK(table.entries[static_cast<std::size_t>(i)] == glm::vec4(medium.sigma_s(), medium.sigma_t));
  }
  CHECK(sampleTransferFunction(f, {0, 400}, {}, 5, 1, TableCover::data).value == Range{0, 400});
}

TEST_CASE("A table agrees with its function wherever data and function meet", "[optics]") {
  const TransferFunction ramp({{10, {kMidGrey, 1}}, {20, {kMidGrey, 3}}});
  const TransferFunction step({{10, {kMidGrey, 1}}, {10, {kMidGrey, 3}}});
  for (const TransferFunction& f : {ramp, step})
    // Data below, above, around and inside the domain, a single value, and data that touch the domain.
    for (const Range& data : {Range{-50, -20}, Range{30, 90}, Range{-1000, 1000}, Range{12, 13}, Range{5, 5},
                              Range{12, 12}, Range{0, 10}, Range{20, 50}, Range{0, 0}}) {
      const TransferTable table = sampleTransferFunction(f, data, {}, 256);
      REQUIRE(table.value.min < table.value.max);
      for (int i = 0; i <= 10; ++i) {
        const double value = data.min + 0.1 * i * (static_cast<double>(data.max) - data.min);
        // Next to a step, and where data only touch it, the table holds a ramp one bin wide.
        if (&f != &ramp && std::abs(value - 10) <= table.value.extent() / 255) continue;
        CHECK(lookup(table, value).a == Approx(f(value).sigma_t).margin(1e-6));
      }
    }
}

TEST_CASE("A threshold at the end of the domain survives the table", "[optics]") {
  const TransferFunction threshold({{100, {kMidGrey, 0}}, {100, {kMidGrey, 2}}});
  const TransferTable table = sampleTransferFunction(threshold, {0, 4095}, {}, 256);
  CHECK(lookup(table, 0).a == 0);
  CHECK(lookup(table, 83).a == 0);
  CHECK(lookup(table, 117).a == 2);
  CHECK(table.isTransparent({0, 60}));
  CHECK_FALSE(table.isTransparent({0, 100}));
}

// The promise that culling stands on. Values looked up are those of the range itself; widening is the table's business.
TEST_CASE("A table that says transparent never returns extinction", "[optics]") {
  std::mt19937 random(11);
  int transparent = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    const TransferFunction f = repeat % 2 ? randomTransferFunction(random, 7) : randomTransferFunction2d(random, 5);
    const int columns = 2 + static_cast<int>(uniform(random, 0, 60)),
              rows = 2 + static_cast<int>(uniform(random, 0, 9));
    const TransferTable table =
        sampleTransferFunction(f, randomRange(random, -20, 110), randomRange(random, -20, 110), columns, rows,
                               repeat % 3 ? TableCover::data : TableCover::varying);
    for (int k = 0; k < 20; ++k) {
      const Range values = randomRange(random, -30, 120), gradients = randomRange(random, -30, 120);
      if (!table.isTransparent(values, gradients)) continue;
      ++transparent;
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j)
          REQUIRE(lookup(table, glm::mix(double(values.min), double(values.max), i / 20.0),
                         glm::mix(double(gradients.min), double(gradients.max), j / 20.0)) == glm::dvec4(0));
    }
  }
  CHECK(transparent > 500);  // it does say so
}

TEST_CASE("A table that says transparent has transparent means too, narrow peaks included", "[optics]") {
  std::mt19937 random(12);
  int transparent = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const TransferFunction f = randomTransferFunction(random, 7);
    const int nodes = 2 + static_cast<int>(uniform(random, 0, 60));
    const TransferTable table =
        sampleTransferFunction(f, randomRange(random, -20, 110), {}, nodes, 1, TableCover::data);
    const std::vector<glm::vec4> means = preintegrate(f, table.value, nodes);
    for (int k = 0; k < 20; ++k) {
      const Range values = randomRange(random, -30, 120);
      if (!table.isTransparent(values)) continue;
      ++transparent;
      for (int i = 0; i <= 12; ++i)
        for (int j = 0; j <= 12; ++j)
          REQUIRE(lookup(means, nodes,
                         tapAt(glm::mix(double(values.min), double(values.max), i / 12.0), table.value, nodes),
                         tapAt(glm::mix(double(values.min), double(values.max), j / 12.0), table.value, nodes)) ==
                  glm::dvec4(0));
    }
  }
  CHECK(transparent > 300);
}

TEST_CASE("Means vanish where the function is transparent over the range widened by a bin", "[optics]") {
  std::mt19937 random(13);
  int transparent = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const TransferFunction f = randomTransferFunction(random, 5);
    const int nodes = 2 + static_cast<int>(uniform(random, 0, 100));
    const Range range{-10, 110};
    const std::vector<glm::vec4> means = preintegrate(f, range, nodes);
    const float bin = range.extent() / static_cast<float>(nodes - 1);
    for (int k = 0; k < 20; ++k) {
      const Range values = randomRange(random, range.min, 70);
      if (!f.isTransparent({values.min - bin, values.max + bin})) continue;
      ++transparent;
      for (int i = 0; i <= 12; ++i)
        for (int j = 0; j <= 12; ++j)
          REQUIRE(lookup(means, nodes, tapAt(glm::mix(double(values.min), double(values.max), i / 12.0), range, nodes),
                         tapAt(glm::mix(double(values.min), double(values.max), j / 12.0), range, nodes)) ==
                  glm::dvec4(0));
    }
  }
  CHECK(transparent > 300);
}

TEST_CASE("The table resolves a bin: what is more than two bins from any medium is culled", "[optics]") {
  const TransferFunction f({{40, {kMidGrey, 0}}, {50, {kMidGrey, 3}}, {60, {kMidGrey, 0}}});
  const TransferTable table = sampleTransferFunction(f, {0, 100}, {}, 101, 1, TableCover::data);  // bins of 1
  CHECK(table.isTransparent({0, 38}));
  CHECK(table.isTransparent({62, 100}));
  CHECK_FALSE(table.isTransparent({0, 40}));
  CHECK_FALSE(table.isTransparent({45, 46}));
  CHECK(table.isTransparent(Range{}));
}

// Closed form: between 0 and 1 sigma_t = v and albedo = v, so the means over [a, b] are (a + b) / 2 and
// (a^2 + a b + b^2) / 3.
TEST_CASE("Means of a ramp are those of its integral, to the rounding of float", "[optics]") {
  const TransferFunction f({{0, {glm::dvec3(0), 0}}, {1, {glm::dvec3(1), 1}}});
  const int nodes = 129;
  const std::vector<glm::vec4> means = preintegrate(f, {0, 1}, nodes);
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j) {
      const double a = i / 128.0, b = j / 128.0;
      const glm::vec4 mean = means[static_cast<std::size_t>(j * nodes + i)];
      REQUIRE(mean.a == Approx(0.5 * (a + b)).epsilon(1.2e-7));
      REQUIRE(mean.r == Approx((a * a + a * b + b * b) / 3).epsilon(1.2e-7));
    }
}

TEST_CASE("Means agree with brute-force quadrature for random functions", "[optics]") {
  std::mt19937 random(5);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const TransferFunction f = randomTransferFunction(random, 8);
    const Range range = repeat % 2 ? Range{-10, 110} : Range{20.3f, 71.7f};
    const int nodes = 33, perBin = 2000;
    const std::vector<glm::vec4> means = preintegrate(f, range, nodes);
    const double bin = (static_cast<double>(range.max) - range.min) / (nodes - 1);
    std::vector<glm::dvec4> bins(nodes - 1, glm::dvec4(0));
    for (int i = 0; i + 1 < nodes; ++i)
      for (int k = 0; k < perBin; ++k)
        bins[static_cast<std::size_t>(i)] +=
            coefficients(f(range.min + bin * (i + (k + 0.5) / perBin))) / double(perBin);
    for (int i = 0; i < nodes; ++i) {
      glm::dvec4 sum(0);
      for (int j = i + 1; j < nodes; ++j) {
        sum += bins[static_cast<std::size_t>(j - 1)];
        const glm::dvec4 mean(means[static_cast<std::size_t>(j * nodes + i)]);
        for (int c = 0; c < 4; ++c)
          // A midpoint next to a step is off by up to its height (5); 8 steps at most, each in one bin.
          REQUIRE(mean[c] == Approx(sum[c] / (j - i)).margin(8 * 5.0 / perBin).epsilon(1e-6));
        REQUIRE(means[static_cast<std::size_t>(j * nodes + i)] == means[static_cast<std::size_t>(i * nodes + j)]);
      }
    }
  }
}

TEST_CASE("A mean over a vanishing interval is the function, at a step the average of both sides", "[optics]") {
  const TransferFunction f({{0, {kMidGrey, 1}}, {5, {kMidGrey, 2}}, {5, {{1, 1, 1}, 6}}, {10, {kMidGrey, 6}}});
  const std::vector<glm::vec4> means = preintegrate(f, {0, 10}, 11);
  for (const int i : {0, 1, 4, 6, 10}) CHECK(means[static_cast<std::size_t>(i * 12)].a == Approx(f(i).sigma_t));
  CHECK(means[5 * 12].a == Approx(4));
  CHECK(means[5 * 12].r == Approx(0.5 * (0.5 * 2 + 6)));
}

TEST_CASE("A peak narrower than a bin keeps its integral in the means", "[optics]") {
  const TransferFunction f({{50.4, {kMidGrey, 0}}, {50.5, {kMidGrey, 100}}, {50.6, {kMidGrey, 0}}});
  const std::vector<glm::vec4> means = preintegrate(f, {0, 100}, 101);
  CHECK(means[51 * 101 + 50].a == Approx(10));  // area 0.1 * 100, over a bin of 1
  CHECK(means[100 * 101].a == Approx(0.1));
  const TransferTable table = sampleTransferFunction(f, {0, 100}, {}, 101, 1, TableCover::data);
  CHECK_FALSE(table.isTransparent({50.2f, 50.3f}));  // though every entry is 0
}

// A prefix integral would have lost the faint part beside the strong one: 1e-9 of a difference of numbers near 1e6.
TEST_CASE("Faint media keep their precision beside strong ones", "[optics]") {
  const TransferFunction f(
      {{0, {kMidGrey, 1e6}}, {1, {kMidGrey, 1e6}}, {1, {kMidGrey, 1e-9}}, {100, {kMidGrey, 1e-9}}});
  const std::vector<glm::vec4> means = preintegrate(f, {0, 100}, 1001);
  CHECK(means[501 * 1001 + 500].a == Approx(1e-9).epsilon(1e-6));
  CHECK(means[1000 * 1001 + 11].a == Approx(1e-9).epsilon(1e-6));
}

TEST_CASE("Narrow ranges far from zero keep their means", "[optics]") {
  const TransferFunction f({{1e6, {kMidGrey, 0}}, {1e6 + 1, {kMidGrey, 8}}});
  const std::vector<glm::vec4> means = preintegrate(f, {1e6f, 1e6f + 1}, 257);
  for (int i = 0; i < 257; ++i)
    for (int j = 0; j < 257; ++j)
      REQUIRE(means[static_cast<std::size_t>(j * 257 + i)].a == Approx(8 * (i + j) / 512.0).epsilon(1e-6));
}

TEST_CASE("Tables that cannot be are refused", "[optics]") {
  const TransferFunction f({{0, {kMidGrey, 0}}, {1, {kMidGrey, 1}}});
  const TransferFunction f2({0, 1}, {0, 1}, std::vector<Medium>(4));
  CHECK_THROWS_WITH(sampleTransferFunction(f, {0, 1}, {}, 1), Catch::Contains("columns is 1"));
  CHECK_THROWS_WITH(sampleTransferFunction(f2, {0, 1}, {0, 1}, 8, 1), Catch::Contains("rows is 1"));
  CHECK_THROWS_WITH(sampleTransferFunction(f, {}, {}, 8), Catch::Contains("empty"));
  CHECK_THROWS_WITH(sampleTransferFunction(f, {0, std::numeric_limits<float>::infinity()}, {}, 8),
                    Catch::Contains("not finite"));
  CHECK_THROWS_WITH(preintegrate(f2, {0, 1}, 8), Catch::Contains("1D"));
  CHECK_THROWS_WITH(preintegrate(f, {0, 1}, 1), Catch::Contains("nodes is 1"));
  CHECK_THROWS_WITH(preintegrate(f, {1, 1}, 4), Catch::Contains("no extent") || Catch::Contains("have an extent"));
}
