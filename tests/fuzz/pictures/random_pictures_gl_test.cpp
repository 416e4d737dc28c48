// A hundred random scenes of emission, each against the reference and against scenes that must be the same.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "fuzz/pictures/compare_scene.h"
#include "support/gl_fixture.h"

using namespace umbrick;

namespace {

// In parts, so that they run beside each other. More scenes, larger pictures and all variants: tests/fuzz/pictures/run.
constexpr std::uint64_t kScenes = 10;

void checkScenes(std::uint64_t part) {
  const auto context = testContext();
  if (!context) return;
  for (std::uint64_t seed = part * kScenes; seed < (part + 1) * kScenes; ++seed) {
    const RandomScene random = randomScene(seed, SceneKind::emission, 24);
    CompareOptions options;
    options.variants = 2;
    options.seed = seed;
    const SceneComparison found = compareScene(*context, random, options);
    INFO("seed " << seed << ": " << random.description);
    for (const std::string& failure : found.failures) {
      UNSCOPED_INFO(failure);
    }
    CHECK(found.failures.empty());
  }
}

}  // namespace

TEST_CASE("Random scenes match the reference and their variants, part 0", "[fuzz]") { checkScenes(0); }
TEST_CASE("Random scenes match the reference and their variants, part 1", "[fuzz][slow]") { checkScenes(1); }
TEST_CASE("Random scenes match the reference and their variants, part 2", "[fuzz][slow]") { checkScenes(2); }
TEST_CASE("Random scenes match the reference and their variants, part 3", "[fuzz][slow]") { checkScenes(3); }
TEST_CASE("Random scenes match the reference and their variants, part 4", "[fuzz][slow]") { checkScenes(4); }
TEST_CASE("Random scenes match the reference and their variants, part 5", "[fuzz][slow]") { checkScenes(5); }
TEST_CASE("Random scenes match the reference and their variants, part 6", "[fuzz][slow]") { checkScenes(6); }
TEST_CASE("Random scenes match the reference and their variants, part 7", "[fuzz][slow]") { checkScenes(7); }
TEST_CASE("Random scenes match the reference and their variants, part 8", "[fuzz][slow]") { checkScenes(8); }
TEST_CASE("Random scenes match the reference and their variants, part 9", "[fuzz][slow]") { checkScenes(9); }

TEST_CASE("A seed makes the same scene again, and another one another scene", "[fuzz]") {
  for (const SceneKind kind : {SceneKind::emission, SceneKind::occlusion, SceneKind::lights, SceneKind::any}) {
    const RandomScene one = randomScene(7, kind), again = randomScene(7, kind), other = randomScene(8, kind);
    CHECK(one.description == again.description);
    CHECK(one.scene == again.scene);
    CHECK(one.scene != other.scene);
  }
}
