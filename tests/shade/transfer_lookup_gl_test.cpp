#include "shade/transfer_lookup.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/field_bricks.h"
#include "support/gl_fixture.h"

using namespace umbrick;

namespace {

struct Texture {
  GLint width = 0, height = 0;
  std::vector<glm::vec4> entries;
  // What linear filtering gives at texture coordinates.
  glm::dvec4 at(double u, double v) const {
    const auto axis = [](double x, int size) {
      const double texel = std::clamp(x * size - 0.5, 0.0, size - 1.0), low = std::min(std::floor(texel), size - 2.0);
      return std::pair(static_cast<std::size_t>(std::max(low, 0.0)), size > 1 ? texel - low : 0);
    };
    const auto [i, fx] = axis(u, width);
    const auto [j, fy] = axis(v, height);
    const auto entry = [&, a = i, b = j](std::size_t x, std::size_t y) {
      const std::size_t column = std::min(a + x, static_cast<std::size_t>(width - 1));
      const std::size_t row = std::min(b + y, static_cast<std::size_t>(height - 1));
      return glm::dvec4(entries[row * static_cast<std::size_t>(width) + column]);
    };
    return (1 - fy) * ((1 - fx) * entry(0, 0) + fx * entry(1, 0)) + fy * ((1 - fx) * entry(0, 1) + fx * entry(1, 1));
  }
};

Texture readBack(const GlFunctions& gl, const TransferLookup& lookup, int width, int height) {
  Texture texture{width, height, std::vector<glm::vec4>(static_cast<std::size_t>(width * height))};
  gl.GetTextureImage(lookup.texture(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texture.entries.size() * 16),
                     texture.entries.data());
  return texture;
}

class OneRange : public Bricks {
 public:
  OneRange(const Range& range, float outside) {
    value = range;
    gradient = {0, 0};
    background = outside;
  }
  void read(const glm::ivec3&, std::span<float>, std::span<float>) const override {}
};

SamplingOptions sampling(Quadrature quadrature, int nodes) {
  SamplingOptions options;
  options.quadrature = quadrature;
  options.tableSize = nodes;
  return options;
}

// A power of two, with room for a node on either side of an inner one.
int tableNodes(int asked) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(asked, 3)))); }

}  // namespace

// Empty space must stay as transparent as the function says, however close to the background a medium begins.
TEST_CASE("A node of the table stands exactly at the background", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const auto& [low, high, background] :
       {std::tuple(0.0f, 1.0f, 0.0f), std::tuple(-1024.0f, 3071.0f, -1024.0f), std::tuple(-1024.0f, 3071.0f, -1000.0f),
        std::tuple(-7.3f, 2.9f, 0.0f), std::tuple(0.0f, 5.5f, 5.5f), std::tuple(2.0f, 9.0f, 2.001f)})
    for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
      for (const int nodes : {2, 3, 16, 255, 256}) {
        INFO("values " << low << " to " << high << ", background " << background << ", nodes " << nodes);
        // Nothing exactly at the background, a medium on either side of it.
        const double b = background, width = 1e-3 * (high - low);
        const TransferFunction valley(
            {{b - width, {glm::dvec3(1), 1}}, {b, {glm::dvec3(1), 0}}, {b + width, {glm::dvec3(1), 1}}});
        const TransferLookup lookup(context->gl(), valley, sampling(quadrature, nodes),
                                    OneRange({low, high}, background));
        CHECK_FALSE(lookup.isVisible({background, background}, {0, 0}));
        CHECK(lookup.isVisible({background, high}, {0, 0}) == (high > background));
        CHECK(lookup.isVisible({low, background}, {0, 0}) == (low < background));
        const int columns = tableNodes(nodes), rows = quadrature == Quadrature::preintegrated ? columns : 1;
        const Texture texture = readBack(context->gl(), lookup, columns, rows);
        // One node alone is transparent, of the pre-integrated table a diagonal element.
        int clear = 0;
        for (int i = 0; i < columns; ++i) {
          const double sigma_t = texture.entries[static_cast<std::size_t>(rows > 1 ? i * columns + i : i)].a;
          clear += sigma_t == 0;
        }
        CHECK(clear == 1);
      }
}

TEST_CASE("What is not visible by its range looks up nothing", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const TransferFunction peak({{0.3, {glm::dvec3(1), 0}}, {0.31, {glm::dvec3(1), 5}}, {0.32, {glm::dvec3(1), 0}}});
  for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
    for (const int asked : {8, 32, 1000}) {
      const int nodes = tableNodes(asked);
      const TransferLookup lookup(context->gl(), peak, sampling(quadrature, asked), OneRange({0, 1}, 0));
      const int rows = quadrature == Quadrature::preintegrated ? nodes : 1;
      const Texture texture = readBack(context->gl(), lookup, nodes, rows);
      int hidden = 0;
      for (double low = 0; low < 1; low += 0.0173)
        for (double high = low; high < 1; high += 0.0317) {
          if (lookup.isVisible({static_cast<float>(low), static_cast<float>(high)}, {0, 0})) continue;
          ++hidden;
          for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= 4; ++j) {
              const auto coordinate = [&](double value) { return (value * (nodes - 1) + 0.5) / nodes; };
              const double front = low + 0.25 * i * (high - low), back = low + 0.25 * j * (high - low);
              const glm::dvec4 found = texture.at(coordinate(front), rows > 1 ? coordinate(back) : 0.5);
              if (found.a != 0) {
                INFO("from " << front << " to " << back << ", nodes " << nodes);
                CHECK(found.a == 0);
              }
            }
        }
      CHECK(hidden > 100);
    }
}
