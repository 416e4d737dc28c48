// A second grid is brought onto the lattice of the first.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "support/closed_forms.h"
#include "support/test_grids.h"
#include "umbrick/grid/emission_grid.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;

namespace {

// A function of the place in the world, cut off at the box of the grid.
ScalarGrid worldField(const IndexBox& domain, const glm::dmat4& transform, double bend) {
  return fieldGrid(
      domain,
      [&](const glm::dvec3& p) {
        const glm::dvec3 world(transform * glm::dvec4(p, 1));
        return 5 + 0.3 * world.x - 0.2 * world.y + 0.1 * world.z + bend * std::sin(world.x);
      },
      transform);
}

}  // namespace

TEST_CASE("A second grid on the same lattice is taken as it is", "[grid][emission]") {
  ScalarGrid first = withTransform(makeDense({20, 20, 20}), crookedTransform());
  const ScalarGrid second = withTransform(makeDense({8, 30, 9}, {5, -7, 2}, 4), crookedTransform());
  const EmissionReport report = addEmission(first, second);
  CHECK_FALSE(report.resampled);
  CHECK(first.emission == second.grid);
}

TEST_CASE("A second grid of another lattice is interpolated, and by how much it is off is measured",
          "[grid][emission]") {
  const glm::dmat4 coarse =
      glm::translate(glm::dmat4(1), glm::dvec3(0.3, -0.2, 0.7)) * glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  ScalarGrid first = withTransform(makeDense({40, 40, 40}, glm::ivec3(-4)), coarse);
  const IndexBox domain{glm::ivec3(-1), glm::ivec3(14)};
  const ScalarGrid linear = worldField(domain, glm::dmat4(1), 0);
  const EmissionReport exact = addEmission(first, linear);
  CHECK(exact.resampled);
  const auto values = first.emission->getConstAccessor();
  for (const glm::ivec3& at : {glm::ivec3(6, 7, 8), glm::ivec3(12, 5, 20), glm::ivec3(20, 20, 20)}) {
    const glm::dvec3 world(coarse * glm::dvec4(at, 1));
    // Linear fields are interpolated exactly where no border is near.
    CHECK(values.getValue({at.x, at.y, at.z}) == Approx(5 + 0.3 * world.x - 0.2 * world.y + 0.1 * world.z));
  }
  const EmissionReport bent = addEmission(first, worldField(domain, glm::dmat4(1), 3));
  CHECK(bent.rms > exact.rms + 1e-3);
  CHECK(bent.max >= bent.rms);
  CHECK(first.emissionBackground() == 0);
}
