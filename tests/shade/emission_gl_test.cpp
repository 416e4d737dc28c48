// Compares emission and absorption with closed forms. Max 1995, doi:10.1109/2945.468400
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "shade/shade_fixture.h"

using namespace umbrick;

namespace {

// The medium ends more than half a slab before the bricks do: where they end, slabs are drawn whole or not at all.
const IndexBox kAroundMedium{glm::ivec3(-16), glm::ivec3(47)};

// Returns a transform that rotates, shears, mirrors and moves, with anisotropic voxels.
glm::dmat4 mediumTransform() {
  return glm::dmat4(0.8, 0.3, -0.1, 0, -0.25, 0.9, 0.2, 0, 0.4, 0.1, -1.1, 0, 12, -5, 3, 1);
}

struct View {
  std::string name;
  Camera camera;
};

// Returns views around and inside a medium of some 26 world units.
std::vector<View> viewsOf(const glm::dmat4& indexToWorld) {
  const glm::dvec3 centre(indexToWorld * glm::dvec4(kMediumIndex.centre(), 1));
  return {{"orthographic face-on", orthographicCamera(centre + glm::dvec3(0, 0, 40), centre, 40, 40)},
          {"orthographic diagonal", orthographicCamera(centre + glm::dvec3(30, -20, 25), centre, 50, 40)},
          {"perspective", perspectiveCamera(centre + glm::dvec3(-30, 25, 35), centre, 0.8, 40)},
          {"inside", perspectiveCamera(centre + glm::dvec3(2, -1, 3), centre + glm::dvec3(9, 5, 1), 1.4, 40)}};
}

// Whatever cuts the medium, each pixel must show alpha = 1 - exp(-sigma_t chord) and albedo times that.
//
// Three errors are allowed for. The chord: clip distances are differences of single-precision depths of some 60 units,
// divided by a rate that may be a tenth, so 60 * 6e-8 * 10 * (two ends) < 1e-4 world units. The formulas of a slab:
// 1e-6 relative. The sum over the slabs: one rounding each.
void checkChords(const Picture& picture, const ResolvedScene& scene, std::span<const ClipPlane> planes, double sigma_t,
                 double chordError = 1e-4) {
  int hits = 0;
  double worst = 0, worstColour = 0;
  for (int y = 0; y < picture.colour.height; ++y)
    for (int x = 0; x < picture.colour.width; ++x) {
      const ViewRay ray = viewRay(scene.camera, x + 0.5, y + 0.5);
      const double chord = keptDepths(ray, planes).length() * ray.stretch();
      const float* pixel = picture.colour.at(x, y);
      const double alpha = -std::expm1(-sigma_t * chord);
      const double rounding = (2e-6 + 2 * kFloatRounding * static_cast<double>(picture.stats.slices)) * alpha;
      // This is the slope of alpha, taken at the end of the uncertain chord where it is larger.
      const double slope = sigma_t * std::exp(-sigma_t * std::max(0.0, chord - chordError));
      const double allowed = std::min(slope * chordError, 1.0) + rounding;
      worst = std::max(worst, chord > 0 ? std::abs(pixel[3] - alpha) / allowed : pixel[3] * 1e30);
      for (int c = 0; c < 3; ++c)
        worstColour = std::max(worstColour, std::abs(pixel[c] - kAlbedo[c] * pixel[3]) -
                                                kFloatRounding * static_cast<double>(picture.stats.slices + 8) * alpha);
      hits += chord > 0 ? 1 : 0;
    }
  CHECK(worst <= 1);
  CHECK(worstColour <= 0);
  CHECK(hits > picture.colour.width * picture.colour.height / 10);
}

}  // namespace

TEST_CASE("A homogeneous box has the opacity of each ray's exact chord", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const glm::dmat4& transform : {glm::dmat4(1), mediumTransform()})
    for (const auto& [name, camera] : viewsOf(transform))
      for (const double spacing : {0.3, 1.0, 4.7}) {
        INFO(name << ", spacing " << spacing << ", crooked " << (transform != glm::dmat4(1)));
        const double sigma_t = 0.07;
        ResolvedScene scene = plainScene(ramp(sigma_t), camera, spacing);
        scene.clipPlanes = boxPlanes(kMediumIndex, transform);
        FieldOptions options;
        options.indexToWorld = transform;
        const FieldBricks volume = fieldFor(
            scene, [](const glm::ivec3&) { return 1.0; }, kAroundMedium, options);
        checkChords(renderPicture(*context, volume, scene), scene, scene.clipPlanes, sigma_t);
      }
}

TEST_CASE("The closed form holds from next to nothing to next to solid", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const View view = viewsOf(glm::dmat4(1))[2];
  const double spacing = 0.8;
  for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
    for (const double tau : {1e-8, 1e-6, 1e-3, 0.4999, 0.5001, 3.0, 1e3, 1e4}) {
      INFO("sigma_t d " << tau << ", midpoint " << (quadrature == Quadrature::midpoint));
      ResolvedScene scene = plainScene(ramp(tau / spacing), view.camera, spacing);
      scene.sampling.quadrature = quadrature;
      scene.clipBox = kMediumIndex;
      const FieldBricks volume = fieldFor(
          scene, [](const glm::ivec3&) { return 1.0; }, kAroundMedium);
      checkChords(renderPicture(*context, volume, scene), scene, boxPlanes(kMediumIndex), tau / spacing);
    }
}

TEST_CASE("A clip plane cuts slabs exactly, however it is tilted", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.1, spacing = 3.3;  // far coarser than what is cut off
  for (const ClipPlane& plane :
       {ClipPlane(0.3, -0.5, 0.8, -6.1), ClipPlane(0, 0, -1, 14.7), ClipPlane(2, 0, 0.02, -31)})
    for (const auto& [name, camera] : viewsOf(glm::dmat4(1))) {
      INFO(name << ", plane " << plane.x << ' ' << plane.y << ' ' << plane.z << ' ' << plane.w);
      ResolvedScene scene = plainScene(ramp(sigma_t), camera, spacing);
      scene.clipPlanes = boxPlanes(kMediumIndex);
      scene.clipPlanes.push_back(plane);
      const FieldBricks volume = fieldFor(
          scene, [](const glm::ivec3&) { return 1.0; }, kAroundMedium);
      const Picture picture = renderPicture(*context, volume, scene);
      checkChords(picture, scene, scene.clipPlanes, sigma_t);
      // The reverse half-space shows the rest: opacities multiply to the whole.
      scene.clipPlanes.back() = -plane;
      const Picture rest = renderPicture(*context, volume, scene);
      scene.clipPlanes.pop_back();
      const Picture whole = renderPicture(*context, volume, scene);
      double worst = 0;
      for (int y = 0; y < picture.colour.height; ++y)
        for (int x = 0; x < picture.colour.width; ++x)
          worst = std::max(worst, std::abs((1.0 - picture.colour.at(x, y)[3]) * (1.0 - rest.colour.at(x, y)[3]) -
                                           (1.0 - whole.colour.at(x, y)[3])));
      CHECK(worst < 2e-4 * sigma_t + 1e-5);
    }
}

TEST_CASE("Nothing nearer than the near distance is seen", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (auto [name, camera] : viewsOf(glm::dmat4(1)))
    for (const double nearDistance : {3.37, 41.9}) {
      if (name == "inside" && nearDistance > 4) continue;  // almost nothing would be left
      INFO(name << ", near " << nearDistance);
      camera.nearDistance = nearDistance;
      ResolvedScene scene = plainScene(ramp(0.1), camera, 2.1);
      scene.clipBox = kMediumIndex;
      const FieldBricks volume = fieldFor(
          scene, [](const glm::ivec3&) { return 1.0; }, kAroundMedium);
      std::vector<ClipPlane> planes = boxPlanes(kMediumIndex);
      const CameraFrame frame = cameraFrame(camera);
      planes.emplace_back(frame.forward, -glm::dot(frame.forward, camera.eye) - nearDistance);
      checkChords(renderPicture(*context, volume, scene), scene, planes, 0.1);
    }
}

// Values are a x + b and sigma_t = c value: along a ray the optical depth is that of the chord's middle
// times its length.
TEST_CASE("A linear field of linear extinction has its exact optical depth", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const glm::dmat4& transform : {glm::dmat4(1), mediumTransform()})
    for (const auto& [name, camera] : viewsOf(transform)) {
      INFO(name << ", crooked " << (transform != glm::dmat4(1)));
      const auto value = [](const glm::dvec3& index) {
        return 0.05 + glm::dot(index, glm::dvec3(0.011, 0.004, 0.013));
      };
      const double sigma_t = 0.1;
      ResolvedScene scene = plainScene(ramp(sigma_t), camera, 1.3);
      scene.clipPlanes = boxPlanes(kMediumIndex, transform);
      FieldOptions options;
      options.indexToWorld = transform;
      const FieldBricks volume = fieldFor(
          scene, [&](const glm::ivec3& i) { return value(glm::dvec3(i)); }, kAroundMedium, options);
      const Picture picture = renderPicture(*context, volume, scene);
      const glm::dmat4 toIndex = glm::inverse(transform);
      double worst = 0;
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
          const DepthInterval kept = keptDepths(ray, scene.clipPlanes);
          const glm::dvec3 middle(toIndex * glm::dvec4(ray.at(kept.length() > 0 ? kept.middle() : 0), 1));
          const double tau = kept.length() > 0 ? sigma_t * value(middle) * kept.length() * ray.stretch() : 0;
          worst = std::max(worst, std::abs(picture.colour.at(x, y)[3] + std::expm1(-tau)));
        }
      // The error is the chord's 1e-4 (see checkChords) times the largest sigma_t, and that of texture coordinates of
      // single precision: 6e-8 of an atlas of 40 texels displaces values by 3e-6 * 0.02, over 40 units of path.
      CHECK(worst < 1e-4 * sigma_t + 1e-5);
    }
}

// A camera in the medium sees what lies in front of it and nothing of what lies behind.
TEST_CASE("A medium whose background value is visible fills the domain and nothing else", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.06;
  // Only voxels around the middle differ from the background, and their values look the same.
  const auto field = [](const glm::ivec3& i) {
    return glm::length(glm::dvec3(i) - glm::dvec3(15, 14, 16)) < 4 ? 3.0 : 2.0;
  };
  const IndexBox domain{glm::ivec3(-5, 3, 1), glm::ivec3(33, 24, 29)};
  for (const glm::dmat4& transform : {glm::dmat4(1), mediumTransform()})
    for (const bool midpoint : {false, true})
      for (const auto& [name, camera] : viewsOf(transform)) {
        INFO(name << ", midpoint " << midpoint << ", crooked " << (transform != glm::dmat4(1)));
        ResolvedScene scene = plainScene(homogeneous(kAlbedo, sigma_t), camera, 1.7);
        if (midpoint) scene.sampling.quadrature = Quadrature::midpoint;
        FieldOptions options;
        options.background = 2;
        options.indexToWorld = transform;
        const FieldBricks volume = fieldFor(scene, field, domain, options);
        REQUIRE(volume.bricks.size() < 9);  // most of the domain has no brick of its own
        const Picture picture = renderPicture(*context, volume, scene);
        checkChords(picture, scene, boxPlanes({glm::dvec3(domain.min), glm::dvec3(domain.max)}, transform), sigma_t);
      }
}

// The table has no extent to spread over, whatever the one value is.
TEST_CASE("A volume of a single value shows the transfer function at exactly that value", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const View view = viewsOf(glm::dmat4(1))[1];
  for (const double value : {0.0, 1.0, -3.0e5, 4.0e8})
    for (const bool midpoint : {false, true}) {
      INFO("value " << value << ", midpoint " << midpoint);
      const double width = std::max(0.25, std::abs(value) * 1e-3), sigma_t = 0.05;
      ResolvedScene scene = plainScene(
          TransferFunction({{value - width, {kAlbedo, 0}}, {value, {kAlbedo, sigma_t}}, {value + width, {kAlbedo, 0}}}),
          view.camera, 1);
      if (midpoint) scene.sampling.quadrature = Quadrature::midpoint;
      FieldOptions options;
      options.background = static_cast<float>(value);
      const FieldBricks volume = fieldFor(
          scene, [&](const glm::ivec3&) { return value; }, kAroundMedium, options);
      checkChords(renderPicture(*context, volume, scene), scene,
                  boxPlanes({glm::dvec3(kAroundMedium.min), glm::dvec3(kAroundMedium.max)}), sigma_t);
    }
}

TEST_CASE("Colours are associated, scale with the ambient light and cover the background", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const TransferFunction transfer({{0, {{1, 0, 0}, 0}}, {0.4, {{0.1, 0.7, 0.2}, 0.3}}, {1, {{0.9, 0.3, 0.6}, 0.02}}});
  const auto wave = [](const glm::ivec3& i) {
    return 0.5 + 0.5 * std::sin(0.4 * i.x) * std::cos(0.3 * i.y + 0.2 * i.z);
  };
  ResolvedScene scene = plainScene(transfer, viewsOf(glm::dmat4(1))[2].camera, 0.5);
  const FieldBricks volume = fieldFor(scene, wave, kAroundMedium);
  const Picture plain = renderPicture(*context, volume, scene);
  const glm::dvec3 largest(1, 0.7, 0.6);
  scene.ambient = {2, 0.5, 0};
  const Picture lit = renderPicture(*context, volume, scene);
  scene.background = glm::dvec3(0.25, 3, 0.125);
  const Picture covered = renderPicture(*context, volume, scene);
  double overAlbedo = 0, ambient = 0, background = 0;
  bool opaque = true;
  for (std::size_t i = 0; i < plain.colour.pixels.size(); i += 4) {
    const float alpha = plain.colour.pixels[i + 3];
    for (int c = 0; c < 3; ++c) {
      const auto at = i + static_cast<std::size_t>(c);
      overAlbedo = std::max(overAlbedo, plain.colour.pixels[at] - largest[c] * alpha);
      ambient = std::max(ambient, std::abs(lit.colour.pixels[at] - scene.ambient[c] * plain.colour.pixels[at]));
      background = std::max(background, std::abs(covered.colour.pixels[at] - lit.colour.pixels[at] -
                                                 (1.0 - alpha) * (*scene.background)[c]));
    }
    opaque = opaque && covered.colour.pixels[i + 3] == 1;
  }
  CHECK(overAlbedo < 2e-5);  // roundings of some 100 slabs
  CHECK(ambient < 1e-6);
  CHECK(background < 1e-6);
  CHECK(opaque);
}

// A pixel is shaded no more when less than 1e-3 gets through: all that is behind could add that much of its colour.
TEST_CASE("Early rejection of saturated pixels changes less than the transmittance it leaves", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  // The medium is black in front and white behind, so that what is rejected would be seen best.
  const TransferFunction transfer({{0, {{0, 0, 0}, 0}}, {1, {{1, 1, 1}, 1.5}}});
  const auto field = [](const glm::ivec3& i) { return std::clamp(1 - i.z / 31.0, 0.0, 1.0); };
  for (const Model model : {Model::emission, Model::cone}) {
    INFO("model " << static_cast<int>(model));
    ResolvedScene scene = plainScene(transfer, viewsOf(glm::dmat4(1))[2].camera, 0.5);
    scene.model = model;
    const FieldBricks volume = fieldFor(scene, field, kAroundMedium);
    const Picture whole = renderPicture(*context, volume, scene);
    scene.sampling.saturation = SamplingOptions().saturation;
    const Picture early = renderPicture(*context, volume, scene);
    CHECK(early.stats.fragments < whole.stats.fragments);
    // The cone's light may also change by what the reach of its walk leaves out, 3e-5 a look (see screen_region.h).
    CHECK(maxDifference(whole.colour, early.colour) < scene.sampling.saturation + (model == Model::cone ? 2e-4 : 0));
    // The second picture has left something out. Behind saturated pixels the cone's light is gone too.
    if (model == Model::emission) CHECK(maxDifference(whole.colour, early.colour) > 0);
  }
}

// Values rise by a constant gradient, and the medium is linear in value and in gradient.
TEST_CASE("A 2D transfer function sees the value and the gradient", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::dvec3 slope(0.011, 0.004, 0.013);
  const auto value = [&](const glm::dvec3& index) { return 0.05 + glm::dot(index, slope); };
  for (const glm::dmat4& transform : {glm::dmat4(1), mediumTransform()})
    for (const double perGradient : {0.0, 2.0}) {
      const double g = glm::length(glm::transpose(glm::inverse(glm::dmat3(transform))) * slope);
      const double byValue = 0.05;
      const TransferFunction transfer(
          {0, 1}, {0, 0.1},
          {{kAlbedo, 0}, {kAlbedo, byValue}, {kAlbedo, 0.1 * perGradient}, {kAlbedo, byValue + 0.1 * perGradient}});
      const Camera camera = viewsOf(transform)[2].camera;
      ResolvedScene scene = plainScene(transfer, camera, 0.9);
      scene.clipPlanes = boxPlanes(kMediumIndex, transform);
      FieldOptions options;
      options.indexToWorld = transform;
      const FieldBricks volume = fieldFor(
          scene, [&](const glm::ivec3& i) { return value(glm::dvec3(i)); }, kAroundMedium, options);
      const Picture picture = renderPicture(*context, volume, scene);
      double worst = 0;
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
          const DepthInterval kept = keptDepths(ray, scene.clipPlanes);
          const glm::dvec3 middle(glm::inverse(transform) *
                                  glm::dvec4(ray.at(kept.length() > 0 ? kept.middle() : 0), 1));
          const double sigma_t = byValue * value(middle) + perGradient * g;
          worst = std::max(worst,
                           std::abs(picture.colour.at(x, y)[3] + std::expm1(-sigma_t * kept.length() * ray.stretch())));
        }
      CHECK(worst < 2e-5);  // as for the linear field above
    }
}

// Without a gradient anywhere, the lattice is looked up at gradient 0, where it may change fast.
TEST_CASE("A 2D transfer function sees a volume without gradients at gradient 0", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.08;
  const TransferFunction transfer(
      {0, 1}, {0, 0.25, 0.5},
      {{kAlbedo, 0}, {kAlbedo, sigma_t}, {kAlbedo, 0}, {kAlbedo, 0}, {kAlbedo, 0}, {kAlbedo, 0}});
  ResolvedScene scene = plainScene(transfer, viewsOf(glm::dmat4(1))[1].camera, 1);
  scene.clipBox = kMediumIndex;
  const FieldBricks volume = fieldFor(
      scene, [](const glm::ivec3&) { return 1.0; }, kAroundMedium);
  checkChords(renderPicture(*context, volume, scene), scene, boxPlanes(kMediumIndex), sigma_t);
}
