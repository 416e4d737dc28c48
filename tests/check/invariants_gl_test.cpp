// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/invariants.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <sstream>

#include "support/gl_fixture.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"

using namespace umbrick;

namespace {

// Returns a medium that is transparent up to 0.3, then denser and of another colour; a few voxels saturate a pixel.
TransferFunction softMedium() {
  return TransferFunction({{0.3, {{0.9, 0.5, 0.2}, 0}}, {0.7, {{0.2, 0.6, 0.9}, 0.2}}, {1.5, {{1, 1, 1}, 0.6}}});
}

ResolvedScene sceneFor(const ScalarGrid& grid, const TransferFunction& transfer, int width = 64, int height = 64) {
  Scene scene;
  scene.transfer = transfer;
  scene.camera.width = width;
  scene.camera.height = height;
  scene.orbit = Orbit{0.4, 0.3};
  return resolveScene(scene, grid.worldBounds(), grid.indexToWorld());
}

std::string print(const std::vector<InvariantResult>& results) {
  std::ostringstream text;
  for (const InvariantResult& r : results)
    text << (r.passed ? "ok      " : "FAILED  ") << r.invariant << ' ' << r.name << ": " << r.value << ", limit "
         << r.limit << ", " << r.samples << " samples, " << r.excluded << " excluded, " << r.detail << '\n';
  return text.str();
}

void checkAllHold(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                  const CheckOptions& options) {
  const std::vector<InvariantResult> results = checkInvariants(context, grid, scene, options);
  INFO(print(results));
  for (const InvariantResult& result : results) {
    CHECK(result.passed);
    // A check that looks at nothing always passes, so each must have measured something, except for borders that
    // a background hides and for methods that are of slices alone.
    const float background = brickGrid(grid)->background;
    const bool hidden = result.invariant == 7 && !scene.transfer.isTransparent({background, background});
    const Method method = options.cone ? options.cone->method : scene.method;
    const bool ofSlices = result.name == "other techniques agree with slices, cone" && method != Method::lightVolume;
    if (!hidden && !ofSlices) CHECK(result.samples > 0);
  }
}

const InvariantResult& find(const std::vector<InvariantResult>& results, const std::string& name) {
  const auto found =
      std::find_if(results.begin(), results.end(), [&](const auto& result) { return result.name == name; });
  REQUIRE(found != results.end());
  return *found;
}

// Bricks with a fault.
class FaultyBricks final : public Bricks {
 public:
  using ReadFault = std::function<void(const glm::ivec3& origin, std::span<float> values)>;
  explicit FaultyBricks(std::unique_ptr<Bricks> sound) : Bricks(*sound), sound_(std::move(sound)) {}
  void read(const glm::ivec3& origin, std::span<float> values, std::span<float> gradients) const override {
    sound_->read(origin, values, gradients);
    if (readFault) readFault(origin, values);
  }
  ReadFault readFault;

 private:
  std::unique_ptr<Bricks> sound_;
};

using BricksFault = std::function<void(FaultyBricks&)>;

// Returns the results for one dense volume in bricks of 8, with `fault` applied to them and `pieceFault` to those
// of its pieces.
std::vector<InvariantResult> checkFaulty(const GlContext& context, const BricksFault& fault,
                                         const BricksFault& pieceFault = {}) {
  const ScalarGrid grid = makeDense({30, 30, 30}, {3, -7, 1});
  ResolvedScene scene = sceneFor(grid, softMedium());
  scene.bricks.interior = 8;
  CheckOptions options;
  options.edges = {8};
  options.views = {checkViews(grid, scene)[1]};
  // The cone has the slabs that umbrick check gives it.
  options.cone = scene;
  options.cone->sampling.spacing = 2.5;
  options.cone->sampling.segments = 4;
  options.cut = [&](const ScalarGrid& volume, const BrickOptions& how) {
    auto bricks = std::make_unique<FaultyBricks>(brickGrid(volume, how));
    const BricksFault& ofThese = volume.grid == grid.grid ? fault : pieceFault;
    if (ofThese) ofThese(*bricks);
    return bricks;
  };
  return checkInvariants(context, grid, scene, options);
}

// Returns a brick in the middle of the volume.
std::size_t middleBrick(const Bricks& bricks) {
  std::size_t middle = 0;
  for (std::size_t i = 0; i < bricks.bricks.size(); ++i)
    if (bricks.bricks[i].origin == glm::ivec3(16, 8, 16)) middle = i;
  REQUIRE(bricks.bricks[middle].origin == glm::ivec3(16, 8, 16));
  return middle;
}

}  // namespace

// Brick edges, pools, cameras and slices on faces are those of CheckOptions and checkViews.
TEST_CASE("All invariants hold on a dense volume", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({45, 50, 40}, {-13, 5, 100});
  CheckOptions options;
  options.probedSlices = 12;
  checkAllHold(*context, grid, sceneFor(grid, softMedium()), options);
}

TEST_CASE("All invariants hold on noise, whose neighbouring voxels differ by as much as they can", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeNoise({30, 26, 34}, {1, -40, -3});
  CheckOptions options;
  options.edges = {8, 16};
  ResolvedScene scene = sceneFor(grid, softMedium(), 61, 48);
  scene.sampling.quadrature = Quadrature::midpoint;
  scene.occlusion.dos.passes = 2;
  scene.occlusion.dos.algorithm = 2;
  options.probedSlices = 12;
  checkAllHold(*context, grid, scene, options);
}

TEST_CASE("All invariants hold on a sparse volume far from the origin", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeSparse({1'000'003, -500'000, -77}, 3, 8, 90);
  CheckOptions options;
  options.edges = {8, 32};
  options.probedSlices = 12;
  checkAllHold(*context, grid, sceneFor(grid, softMedium()), options);
}

TEST_CASE("All invariants hold for a rotated, sheared and mirrored volume", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(makeSparse({-40, 0, 9}, 5, 6, 64), crookedTransform());
  CheckOptions options;
  options.edges = {8, 16};
  options.probedSlices = 12;
  // No parallel view sees faces edge-on here, so that V beside them is not measured.
  const auto results = checkInvariants(*context, grid, sceneFor(grid, softMedium()), options);
  INFO(print(results));
  for (const InvariantResult& result : results) CHECK(result.passed);
}

TEST_CASE("All invariants hold where the background is visible", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeSphereLevelSet(12, 1, {3, 40, -5});
  // The fog is thin outside of the ball (background 3), and denser inside.
  const TransferFunction fog({{-3, {{1, 0.8, 0.6}, 0.3}}, {0, {{1, 1, 1}, 0.1}}, {3, {{0.5, 0.7, 1}, 0.02}}});
  CheckOptions options;
  options.edges = {8, 16};
  options.probedSlices = 12;
  checkAllHold(*context, grid, sceneFor(grid, fog), options);
}

// Slices only multiply what is on the lattice of the light, which depends on the view and not on bricks: the limits
// have no room for light that is left out.
TEST_CASE("All invariants hold for light by ordinates", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const ScalarGrid& grid :
       {makeDense({30, 26, 34}, {1, -40, -3}), withTransform(makeSparse({-40, 0, 9}, 5, 5, 56), crookedTransform())}) {
    ResolvedScene scene = sceneFor(grid, softMedium(), 48, 40);
    scene.method = Method::ordinates;
    scene.occlusion.ordinates.directions = 6;
    scene.occlusion.aperture = 1.2;
    scene.bricks.interior = 8;
    CheckOptions options;
    options.edges = {8, 32};
    options.probedSlices = 4;
    const std::vector<CheckView> views = checkViews(grid, scene);
    options.views = {views[1], views[2], views.back()};
    const auto results = checkInvariants(*context, grid, scene, options);
    INFO(print(results));
    for (const InvariantResult& result : results) {
      CHECK(result.passed);
      CHECK(result.limitFrom.find("deviations") == std::string::npos);
    }
    CHECK(find(results, "a pool smaller than the volume, cone").samples > 0);
    CHECK(find(results, "several textures, cone").samples > 0);
  }
}

// A slab from 1 to 1 gets the mean of both sides of a step at 1, so that it can be seen, though the function
// is 0 there.
TEST_CASE("Culling keeps bricks whose lowest value is at a falling step", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(
      {20, 20, 20}, {0, 0, 0}, [](const glm::ivec3&) { return 1.0; }, 2);
  const Medium dense{{1, 1, 1}, 0.3}, nothing{{1, 1, 1}, 0};
  const TransferFunction falling({{0, dense}, {1, dense}, {1, nothing}, {3, nothing}});
  CheckOptions options;
  options.edges = {8};
  const ResolvedScene scene = sceneFor(grid, falling);
  options.views = {{"the scene's camera", scene.camera, 0}};
  const auto results = checkInvariants(*context, grid, scene, options);
  INFO(print(results));
  CHECK(find(results, "culled equals not culled, emission").passed);
}

TEST_CASE("Sound bricks pass what faulty ones fail", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, {});
  INFO(print(results));
  for (const InvariantResult& result : results) CHECK(result.passed);
}

TEST_CASE("One wrong apron voxel is found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    bricks.readFault = [](const glm::ivec3& origin, std::span<float> values) {
      if (origin == glm::ivec3(16, 8, 16)) values[0] += 0.01f;
    };
  });
  INFO(print(results));
  const InvariantResult& aprons = find(results, "aprons equal the neighbours' voxels");
  CHECK_FALSE(aprons.passed);
  CHECK(aprons.value == 1);
}

TEST_CASE("A layer of wrong apron voxels is found in samples and pictures", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    const glm::ivec3 edge = bricks.layout.edge();
    // The layer next to the voxels that the brick owns: what lies beyond it may be read by light alone.
    const int first = (bricks.layout.apron - 1) * edge.x * edge.y;
    bricks.readFault = [edge, first](const glm::ivec3& origin, std::span<float> values) {
      if (origin == glm::ivec3(16, 8, 16))
        for (int i = first; i < first + edge.x * edge.y; ++i) values[static_cast<std::size_t>(i)] += 0.1f;
    };
  });
  INFO(print(results));
  CHECK_FALSE(find(results, "aprons equal the neighbours' voxels").passed);
  CHECK_FALSE(find(results, "interpolated values equal BoxSampler's").passed);
  CHECK_FALSE(find(results, "bricked equals unbricked, emission").passed);
  CHECK_FALSE(find(results, "bricked equals unbricked, cone").passed);
}

TEST_CASE("A brick that is missing is found, also by its shadow of ordinates", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 30, 30}, {3, -7, 1});
  ResolvedScene scene = sceneFor(grid, softMedium());
  scene.method = Method::ordinates;
  scene.bricks.interior = 8;
  CheckOptions options;
  options.edges = {8};
  options.views = {checkViews(grid, scene)[1]};
  options.cut = [&](const ScalarGrid& volume, const BrickOptions& how) {
    auto bricks = std::make_unique<FaultyBricks>(brickGrid(volume, how));
    if (volume.grid == grid.grid)  // not the grids of its pieces
      bricks->bricks.erase(bricks->bricks.begin() + static_cast<std::ptrdiff_t>(middleBrick(*bricks)));
    return bricks;
  };
  const auto results = checkInvariants(*context, grid, scene, options);
  INFO(print(results));
  CHECK_FALSE(find(results, "bricked equals unbricked, cone").passed);
  CHECK_FALSE(find(results, "V across bricks, cone").passed);
}

TEST_CASE("A brick that is missing is found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    bricks.bricks.erase(bricks.bricks.begin() + static_cast<std::ptrdiff_t>(middleBrick(bricks)));
  });
  INFO(print(results));
  CHECK_FALSE(find(results, "bricked equals unbricked, emission").passed);
  CHECK_FALSE(find(results, "bricked equals unbricked, cone").passed);
  CHECK_FALSE(find(results, "V across bricks, cone").passed);
}

// Unlike the other laws this one allows for the errors of both techniques, so that it finds what is larger than they
// are.
TEST_CASE("Slices without a layer of bricks differ from techniques on the CPU", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    std::erase_if(bricks.bricks, [](const Brick& brick) { return brick.origin.z == 16; });
  });
  INFO(print(results));
  CHECK_FALSE(find(results, "other techniques agree with slices, emission").passed);
  CHECK_FALSE(find(results, "other techniques agree with slices, cone").passed);
}

TEST_CASE("A brick that is drawn twice is found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    const std::size_t middle = middleBrick(bricks);
    bricks.bricks.push_back(bricks.bricks[middle]);
  });
  INFO(print(results));
  CHECK(find(results, "every pixel of a slice is shaded").passed);
  CHECK_FALSE(find(results, "no pixel of a slice is shaded twice").passed);
  CHECK_FALSE(find(results, "bricked equals unbricked, emission").passed);
}

TEST_CASE("A brick that is not in its place is found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(
      *context, [](FaultyBricks& bricks) { bricks.bricks[middleBrick(bricks)].origin += glm::ivec3(1, 0, 0); });
  INFO(print(results));
  CHECK_FALSE(find(results, "every pixel of a slice is shaded").passed);
  CHECK_FALSE(find(results, "no pixel of a slice is shaded twice").passed);
}

// Where bricks overlap and do not agree, the order shows.
TEST_CASE("Bricks whose order matters are found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    Brick overlapping = bricks.bricks[middleBrick(bricks)];
    overlapping.origin += 4;
    bricks.bricks.push_back(overlapping);
    bricks.readFault = [overlapping](const glm::ivec3& origin, std::span<float> values) {
      if (origin == overlapping.origin) std::fill(values.begin(), values.end(), 1.2f);
    };
  });
  INFO(print(results));
  CHECK_FALSE(find(results, "bricks drawn in reverse, emission").passed);
  CHECK_FALSE(find(results, "bricks drawn in reverse, cone").passed);
}

TEST_CASE("A range by which a visible brick is culled is found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto results = checkFaulty(*context, [](FaultyBricks& bricks) {
    bricks.bricks[middleBrick(bricks)].value = {0, 0.1f};
  });
  INFO(print(results));
  CHECK_FALSE(find(results, "ranges hold all voxels of a brick").passed);
  CHECK_FALSE(find(results, "culled equals not culled, emission").passed);
  CHECK_FALSE(find(results, "culled equals not culled, cone").passed);
  CHECK_FALSE(find(results, "V across skipped space, cone").passed);
  CHECK(find(results, "bricked equals unbricked, emission").passed);
}

// Bricks beyond the domain hold nothing, but slabs reach into the domain from there.
TEST_CASE("Bricks that are missing around a volume are found", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const auto withoutRim = [](FaultyBricks& bricks) {
    std::erase_if(bricks.bricks, [&](const Brick& brick) {
      for (int axis = 0; axis < 3; ++axis)
        if (brick.origin[axis] > bricks.domain.max[axis] ||
            brick.origin[axis] + bricks.layout.interior[axis] - 1 < bricks.domain.min[axis])
          return true;
      return false;
    });
  };
  const auto results = checkFaulty(*context, {}, withoutRim);
  const InvariantResult& border = find(results, "the border of pieces of the volume is whole");
  INFO(border.detail << ": " << border.value << ", limit " << border.limit);
  CHECK_FALSE(border.passed);
}

TEST_CASE("What cannot be checked is reported with the reason", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({10, 10, 10});
  ResolvedScene scene = sceneFor(grid, softMedium());
  CHECK_THROWS_AS(checkViews(makeVoxels({}), scene), InvalidArgument);
  CheckOptions options;
  options.edges = {12};
  CHECK_THROWS_WITH(checkInvariants(*context, grid, scene, options), Catch::Contains("multiple of 8"));
}

// Thick slabs need wide aprons, and those of a view whose slices lie on faces stay there.
TEST_CASE("All invariants hold where the cone has thicker slabs than emission", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({30, 26, 34}, {1, -40, -3});
  const ResolvedScene scene = sceneFor(grid, softMedium(), 48, 40);
  CheckOptions options;
  options.edges = {8, 16};
  options.probedSlices = 4;
  options.cone = scene;
  options.cone->sampling.spacing = 2.5;
  options.cone->sampling.segments = 4;
  options.cone->occlusion.ordinates.directions = 6;
  checkAllHold(*context, grid, scene, options);
}

TEST_CASE("A check that is stopped tells which invariants it has measured", "[check][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeDense({20, 20, 20}, {3, -7, 1});
  const ResolvedScene scene = sceneFor(grid, softMedium(), 32, 32);
  CheckOptions options;
  options.edges = {8};
  options.probedSlices = 2;
  options.views = {checkViews(grid, scene)[1]};
  const auto stoppedAt = [&](const std::string& text) {
    double last = 0;
    options.progress = [&](const std::string& step, double done) {
      CHECK(done >= last);
      CHECK(done <= 1);
      last = done;
      return step.find(text) == std::string::npos;
    };
    return checkInvariants(*context, grid, scene, options);
  };

  for (const InvariantResult& result : stoppedAt("voxels")) {
    CHECK_FALSE(result.complete);
    CHECK_FALSE(result.passed);
    CHECK(result.samples == 0);
  }
  const auto half = stoppedAt("cone");
  INFO(print(half));
  for (const char* name : {"aprons equal the neighbours' voxels", "every pixel of a slice is shaded",
                           "the border of pieces of the volume is whole", "bricked equals unbricked, emission"}) {
    CHECK(find(half, name).complete);
    CHECK(find(half, name).passed);
  }
  CHECK_FALSE(find(half, "bricked equals unbricked, cone").complete);
  for (const InvariantResult& result : stoppedAt("never said")) CHECK(result.complete);
}
