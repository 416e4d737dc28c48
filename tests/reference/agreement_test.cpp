// The two integrators against each other, and what must not change a picture.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "reference/reference_fixture.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

// A function with soft and hard parts: a steep peak, a step and a slope.
TransferFunction variedTransfer() {
  return TransferFunction({{0.05, {{0.9, 0.3, 0.1}, 0}},
                           {0.4, {{0.9, 0.5, 0.2}, 0.15}},
                           {0.41, {{0.2, 0.4, 1}, 1.5}},
                           {0.42, {{0.3, 0.8, 0.6}, 0.1}},
                           {0.6, {{0.3, 0.8, 0.6}, 0.3}},
                           {0.6, {{1, 1, 1}, 3}},
                           {0.8, {{1, 0.9, 0.8}, 5}}});
}

// A function that is bilinear between lattice lines, and opaque where the gradient is large.
TransferFunction variedTransfer2d() {
  return TransferFunction({0.05, 0.5, 1}, {0, 0.05, 0.2},
                          {{{1, 0, 0}, 0},
                           {{1, 0.5, 0}, 0.05},
                           {{1, 1, 0}, 0.3},
                           {{0, 1, 0}, 0},
                           {{0, 1, 0.5}, 0.4},
                           {{0, 1, 1}, 1.5},
                           {{0, 0, 1}, 0.1},
                           {{0.5, 0, 1}, 1},
                           {{1, 0, 1}, 2}});
}

// Lights that are soft, sharp, listed and a map, tilted, with colours whose channels sum to about 1 each.
std::vector<LightSource> colouredLights() {
  return {{LightFrame::view, ConeLight{{1, 0.3, 1}, 0.5, {0.4, 0.1, 0.05}}},
          {LightFrame::view, ConeLight{{-0.5, 0.2, 1}, 0, {0.1, 0.2, 0.4}}},
          {LightFrame::world, ConeLight{{25, -22, 19}, 1.1, {0.2, 0.3, 0.2}}},
          {LightFrame::view, ListedLight{{{{0, 0.7, 1}, 0.5, {0.3, 0.3, 0.6}}, {{0.1, -0.6, 1}, 1, {0.05, 0.2, 0}}}}},
          environmentOf(8, 5, {0.5, 0.4, 0.6}, true)};
}

struct Case {
  std::string name;
  ScalarGrid grid;
  ResolvedScene scene;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Model model : {Model::emission, Model::cone, Model::coneRay, Model::ambient, Model::lights})
    for (const bool parallel : {false, true})
      for (const bool crooked : {false, true}) {
        // For the slower combinations one property at a time is enough.
        if (parallel && crooked) continue;
        const glm::dmat4 transform = crooked ? crookedTransform() : glm::dmat4(1);
        const glm::dvec3 centre(transform * glm::dvec4(14, 14, 14, 1));
        const glm::dvec3 eye = centre + glm::dvec3(25, -22, 19);
        const Camera camera =
            parallel ? orthographicCamera(eye, centre, 36, 12) : perspectiveCamera(eye, centre, 0.9, 12);
        ResolvedScene scene = plainScene(parallel ? variedTransfer2d() : variedTransfer(), camera, 1);
        scene.model = model;
        scene.occlusion.aperture = 1.2;
        scene.ambient = {1.5, 1, 0.5};
        scene.lights = colouredLights();
        if (crooked) scene.clipPlanes = {{0.3, -0.5, 0.8, 3 - glm::dot(glm::dvec3(0.3, -0.5, 0.8), centre)}};
        if (parallel) scene.background = glm::dvec3(0.2, 0.1, 0.4);
        all.push_back({modelName(model) + (parallel  ? " orthographic 2D"
                                           : crooked ? " crooked, clipped"
                                                     : " perspective"),
                       withTransform(makeDense(glm::ivec3(28)), transform), scene});
      }
  return all;
}

ReferenceOptions monteCarlo(int samples, std::uint64_t seed) {
  ReferenceOptions options;
  options.integrator = Integrator::monteCarlo;
  options.samples = samples;
  options.seed = seed;
  return options;
}

}  // namespace

// The mean square of N independent normal deviates is 1 with a standard deviation of sqrt(2 / N). The channels of a
// pixel say much the same, so N is about 288 for 144 pixels. This gives 0.083, and the limit is four of them. The error
// that directions and tolerance leave in the quadrature, some 5e-3, is a twentieth of the variance of 500 paths. A bias
// of one standard error would double the mean.
TEST_CASE("Quadrature and Monte Carlo agree within the standard error that Monte Carlo states", "[reference][slow]") {
  for (const auto& [name, grid, scene] : cases()) {
    INFO(name);
    ReferenceOptions options;
    options.directions = 150;
    options.tolerance = 1e-3;
    const ReferencePicture exact = renderReference(grid, scene, options);
    const int samples = 500;
    const ReferencePicture random = renderReference(grid, scene, monteCarlo(samples, 11));
    double squares = 0, bias = 0, variance = 0;
    int count = 0;
    for (std::size_t i = 0; i < exact.colour.pixels.size(); ++i) {
      const double error = random.standardError.pixels[i];
      const double difference = double(random.colour.pixels[i]) - double(exact.colour.pixels[i]);
      // Of a rare event, 500 paths may have seen none, or too few to know how rare it is.
      if (error < 2.0 / samples) {
        CHECK(std::abs(difference) < 12.0 / samples);
        continue;
      }
      squares += (difference / error) * (difference / error);
      bias += difference;
      variance += error * error;
      ++count;
    }
    REQUIRE(count > 200);
    INFO("mean square " << squares / count << " of " << count << ", bias " << bias / count);
    CHECK(std::abs(squares / count - 1) < 0.35);
    // This is the mean over all pixels. Their four channels deviate together, so its variance is four times as large.
    CHECK(std::abs(bias) / count < 4 * std::sqrt(4 * variance) / count);
  }
}

TEST_CASE("Pictures do not depend on threads, and random ones only on the seed", "[reference]") {
  const Case made = cases()[3];  // model cone, perspective
  for (const Integrator integrator : {Integrator::quadrature, Integrator::monteCarlo}) {
    ReferenceOptions options = monteCarlo(40, 3);
    options.integrator = integrator;
    options.directions = 16;
    options.threads = 1;
    const ReferencePicture one = renderReference(made.grid, made.scene, options);
    options.threads = 4;
    const ReferencePicture four = renderReference(made.grid, made.scene, options);
    CHECK(one.colour.pixels == four.colour.pixels);
    CHECK(one.standardError.pixels == four.standardError.pixels);
    CHECK(one.depth.pixels == four.depth.pixels);
    options.seed = 4;
    const ReferencePicture other = renderReference(made.grid, made.scene, options);
    CHECK((one.colour.pixels == other.colour.pixels) == (integrator == Integrator::quadrature));
  }
}

TEST_CASE("The standard error asked for is reached, and no sooner than it must", "[reference]") {
  const Case made = cases()[3];
  ReferenceOptions options = monteCarlo(100'000, 9);
  options.standardError = 0.02;
  const ReferencePicture coarse = renderReference(made.grid, made.scene, options);
  options.standardError = 0.01;
  const ReferencePicture fine = renderReference(made.grid, made.scene, options);
  float largest = 0;
  for (const float error : fine.standardError.pixels) largest = std::max(largest, error);
  // The ambient light of 1.5 scales what the paths bring.
  CHECK(largest <= 1.5 * 0.01 * (1 + 1e-6));
  // Half the error takes four times the paths, but for pixels that took the fewest paths that count at all.
  CHECK(fine.stats.eyeRays > 2 * coarse.stats.eyeRays);
  CHECK(fine.stats.eyeRays < 5 * coarse.stats.eyeRays);
}

// The standard error of a pixel is that of its mean over seeds.
TEST_CASE("The stated standard error is the scatter of pictures of other seeds", "[reference][slow]") {
  const Case made = cases()[3];
  const int seeds = 40;
  std::vector<double> sum, squares, stated;
  for (int seed = 0; seed < seeds; ++seed) {
    const ReferencePicture picture =
        renderReference(made.grid, made.scene, monteCarlo(100, static_cast<unsigned>(seed)));
    sum.resize(picture.colour.pixels.size());
    squares.resize(sum.size());
    stated.resize(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double value = picture.colour.pixels[i], error = picture.standardError.pixels[i];
      sum[i] += value;
      squares[i] += value * value;
      stated[i] += error * error / seeds;
    }
  }
  double scatter = 0, expected = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    scatter += (squares[i] - sum[i] * sum[i] / seeds) / (seeds - 1);
    expected += stated[i];
  }
  // A variance that is estimated from 39 degrees of freedom in each of some 100 independent pixels is off by 2.3 %; the
  // limit is four of them.
  CHECK(scatter == Approx(expected).epsilon(0.1));
}

TEST_CASE("Skipping empty space changes no picture and visits less", "[reference]") {
  const ScalarGrid grid = makeSparse();
  const glm::dvec3 centre(100);
  for (const Model model : {Model::emission, Model::cone}) {
    ResolvedScene scene = plainScene(TransferFunction({{0.02, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.3, 0.8, 0.6}, 1}}}),
                                     perspectiveCamera(centre + glm::dvec3(150, -140, 130), centre, 0.9, 12), 1);
    scene.model = model;
    ReferenceOptions options;
    options.directions = 16;
    const ReferencePicture skipped = renderReference(grid, scene, options);
    options.skipEmpty = false;
    const ReferencePicture visited = renderReference(grid, scene, options);
    // The same cells come in the same order, so only the rounding of steps along the ray differs.
    CHECK(maxDifference(skipped.colour, visited.colour) < 1e-6);
    CHECK(skipped.stats.cells * 4 < visited.stats.cells);
  }
}

// The unit of the world does not matter when extinction is scaled by the inverse and lengths alike.
TEST_CASE("Huge, tiny and far transforms make the picture of the unit one", "[reference]") {
  const glm::dvec3 centre(14), eye(39, -8, 33);
  const auto made = [&](double scale, const glm::dvec3& offset, Model model) {
    glm::dmat4 transform = glm::dmat4(scale);
    transform[3] = glm::dvec4(offset, 1);
    const auto world = [&](const glm::dvec3& p) { return scale * p + offset; };
    ResolvedScene scene =
        plainScene(variedTransfer().scaled(1 / scale), perspectiveCamera(world(eye), world(centre), 0.9, 10), scale);
    scene.model = model;
    ReferenceOptions options;
    options.directions = 16;
    return renderReference(withTransform(makeDense(glm::ivec3(28)), transform), scene, options).colour;
  };
  for (const Model model : {Model::emission, Model::cone}) {
    const Image unit = made(1, glm::dvec3(0), model);
    // OpenVDB has no voxels smaller than about 1.5e-5.
    CHECK(maxDifference(unit, made(2e-5, glm::dvec3(0), model)) < 1e-5);
    CHECK(maxDifference(unit, made(1e6, glm::dvec3(0), model)) < 1e-5);
    // A million units from the origin double precision has 1e-10 of a voxel left.
    CHECK(maxDifference(unit, made(1, glm::dvec3(1e6, -1e6, 1e6), model)) < 1e-5);
  }
}

TEST_CASE("Voxels a million from the origin make the same picture", "[reference]") {
  const glm::dvec3 centre(14), eye(39, -8, 33);
  std::vector<Image> pictures;
  for (const glm::ivec3& origin : {glm::ivec3(0), glm::ivec3(1000000, -1000000, 1000000)}) {
    const glm::dvec3 offset(origin);
    ResolvedScene scene = plainScene(variedTransfer(), perspectiveCamera(eye + offset, centre + offset, 0.9, 10), 1);
    scene.model = Model::cone;
    ReferenceOptions options;
    options.directions = 16;
    pictures.push_back(renderReference(makeDense(glm::ivec3(28), origin), scene, options).colour);
  }
  // Places of 1e6 voxels have a rounding of 1e-10. V of 16 directions jumps where a path touches a voxel's edge.
  CHECK(maxDifference(pictures[0], pictures[1]) < 1e-4);
}

// The function is a ramp to an extinction that no step could track. It is opaque from where it begins, for
// either integrator.
TEST_CASE("Media as solid as numbers allow are integrated by both", "[reference]") {
  const ScalarGrid grid = makeNoise({12, 12, 12});
  for (const double sigma_t : {1e6, 1e300}) {
    ResolvedScene scene = plainScene(TransferFunction({{0.5, {{1, 0.5, 0.2}, 0}}, {1, {{1, 0.5, 0.2}, sigma_t}}}),
                                     orthographicCamera({30, 25, 40}, {6, 6, 6}, 24, 12), 1);
    for (const Model model : {Model::emission, Model::cone}) {
      scene.model = model;
      ReferenceOptions options;
      options.directions = 32;
      const ReferencePicture exact = renderReference(grid, scene, options);
      const ReferencePicture random = renderReference(grid, scene, monteCarlo(8, 3));
      double worst = 0;
      std::size_t opaque = 0;
      for (std::size_t i = 3; i < exact.colour.pixels.size(); i += 4) {
        CHECK(std::isfinite(exact.colour.pixels[i - 1]));
        worst = std::max<double>(worst, std::abs(exact.colour.pixels[i] - random.colour.pixels[i]));
        opaque += exact.colour.pixels[i] == 1 ? 1u : 0u;
      }
      CHECK(opaque > 20);
      // Rays that graze a surface by less than 1e-4 of a voxel may see it or not; none of these rays does so.
      CHECK(worst < 1e-3);
    }
  }
}

// OpenVDB itself overflows in the last 4096 voxels.
TEST_CASE("Voxels near the limits of 32-bit indices are integrated or refused", "[reference]") {
  constexpr int limit = std::numeric_limits<int>::max();
  for (const auto& [x, taken] :
       {std::pair(limit - 4112, true), std::pair(-limit + 16, true), std::pair(limit - 4111, false),
        std::pair(limit, false), std::pair(-limit + 15, false)}) {
    INFO(x);
    const glm::dvec3 at(x, 0, 0);
    const ResolvedScene scene = plainScene(variedTransfer(), orthographicCamera(at + glm::dvec3(0, 0, 9), at, 3, 8), 1);
    std::string complaint;
    double alpha = 0;
    try {
      alpha = renderReference(makeVoxels({{glm::ivec3(x, 0, 0), 0.7f}}), scene).colour.at(4, 4)[3];
    } catch (const InvalidArgument& error) {
      complaint = error.what();
    }
    CHECK((alpha > 0.1) == taken);
    CHECK_THAT(complaint, Catch::Contains(taken ? "" : std::to_string(x)));
    CHECK(complaint.empty() == taken);
  }
}

TEST_CASE("A job that is stopped says how far it came and keeps what it has", "[reference]") {
  const Case made = cases()[0];
  ReferenceOptions options;
  options.threads = 1;
  int calls = 0;
  double last = 0;
  options.progress = [&](double share) {
    CHECK(share > last);
    last = share;
    return ++calls < 90;
  };
  const ReferencePicture stopped = renderReference(made.grid, made.scene, options);
  CHECK_FALSE(stopped.complete);
  CHECK(stopped.stats.share == Approx(90.0 / 144));
  options.progress = {};
  const ReferencePicture whole = renderReference(made.grid, made.scene, options);
  CHECK(whole.complete);
  std::size_t equal = 0, blank = 0;
  for (std::size_t i = 0; i < whole.colour.pixels.size(); ++i) {
    equal += stopped.colour.pixels[i] == whole.colour.pixels[i] ? 1u : 0u;
    blank += stopped.colour.pixels[i] == 0 ? 1u : 0u;
  }
  CHECK(equal + blank >= whole.colour.pixels.size());
  CHECK(equal > blank);
}

TEST_CASE("Impossible requests are refused with the field and its value", "[reference]") {
  const Case made = cases()[0];
  const auto complaint = [&](const std::function<void(ReferenceOptions&, ResolvedScene&)>& change) {
    ReferenceOptions options;
    ResolvedScene scene = made.scene;
    change(options, scene);
    try {
      renderReference(made.grid, scene, options);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using Catch::Contains;
  CHECK_THAT(complaint([](ReferenceOptions& o, ResolvedScene&) { o.step = -1; }), Contains("step") && Contains("-1"));
  CHECK_THAT(complaint([](ReferenceOptions& o, ResolvedScene&) { o.tolerance = 0; }),
             Contains("tolerance") && Contains("0"));
  CHECK_THAT(complaint([](ReferenceOptions& o, ResolvedScene&) { o.directions = 0; }), Contains("directions"));
  CHECK_THAT(complaint([](ReferenceOptions& o, ResolvedScene&) { o.samples = 1; }), Contains("samples"));
  CHECK_THAT(complaint([](ReferenceOptions& o, ResolvedScene&) { o.standardError = std::nan(""); }),
             Contains("standard error"));
  CHECK_THAT(complaint([](ReferenceOptions&, ResolvedScene& s) { s.camera.fov = 4; }), Contains("fov"));
}
