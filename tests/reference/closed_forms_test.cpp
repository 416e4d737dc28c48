// The reference against closed forms: emission and absorption. Max 1995, doi:10.1109/2945.468400
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <numbers>

#include "reference/reference_fixture.h"

using namespace umbrick;

namespace {

const glm::dvec3 kAlbedo(0.9, 0.5, 0.2);
const IndexBox kDomain{glm::ivec3(0), glm::ivec3(24)};
// A picture holds single precision: half a unit in the last place of numbers near 1, and the same again for the sum.
constexpr double kRounding = 2 * kFloatRounding;

struct View {
  std::string name;
  Camera camera;
};

std::vector<View> viewsOf(const glm::dmat4& indexToWorld) {
  const glm::dvec3 centre(indexToWorld * glm::dvec4(12, 12, 12, 1));
  return {{"orthographic face-on", orthographicCamera(centre + glm::dvec3(0, 0, 40), centre, 40, 24)},
          {"orthographic diagonal", orthographicCamera(centre + glm::dvec3(30, -20, 25), centre, 50, 24)},
          {"perspective", perspectiveCamera(centre + glm::dvec3(-30, 25, 35), centre, 0.8, 24)},
          {"1 degree", perspectiveCamera(centre + glm::dvec3(-900, 700, 1100), centre, std::numbers::pi / 180, 24)},
          {"150 degrees", perspectiveCamera(centre + glm::dvec3(-4, 9, 10), centre, 150 * std::numbers::pi / 180, 24)},
          {"inside", perspectiveCamera(centre + glm::dvec3(2, -1, 3), centre + glm::dvec3(9, 5, 1), 1.4, 24)}};
}

// Returns the largest difference of opacity, and of colour over opacity times albedo, over all pixels.
// @param opacity  that of a ray, from which the depths in front of the eye follow
template <class Opacity>
double worstOpacity(const ReferencePicture& picture, const ResolvedScene& scene, const Opacity& opacity) {
  double worst = 0;
  for (int y = 0; y < picture.colour.height; ++y)
    for (int x = 0; x < picture.colour.width; ++x) {
      const double alpha = opacity(viewRay(scene.camera, x + 0.5, y + 0.5));
      const float* pixel = picture.colour.at(x, y);
      worst = std::max(worst, std::abs(pixel[3] - alpha));
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(pixel[c] - kAlbedo[c] * alpha));
    }
  return worst;
}

}  // namespace

TEST_CASE("A homogeneous box has the opacity of each ray's exact chord, from next to nothing to solid", "[reference]") {
  for (const glm::dmat4& transform : {glm::dmat4(1), crookedTransform()})
    for (const auto& [name, camera] : viewsOf(transform))
      for (const double sigma_t : {1e-8, 0.07, 1e4}) {
        INFO(name << ", sigma_t " << sigma_t << ", crooked " << (transform != glm::dmat4(1)));
        ResolvedScene scene = plainScene(homogeneous(kAlbedo, sigma_t), camera, 1);
        const std::vector<ClipPlane> box = boxPlanes({glm::dvec3(kDomain.min), glm::dvec3(kDomain.max)}, transform);
        // Background and voxels alike are the medium, which ends where the domain does.
        const ScalarGrid grid = fieldGrid(
            kDomain, [](const glm::dvec3&) { return 3.0; }, transform, 1);
        const auto chordOpacity = [&](const std::vector<ClipPlane>& planes) {
          return [&scene, planes, sigma_t](const ViewRay& ray) {
            return -std::expm1(-sigma_t * keptDepths(ray, planes).length() * ray.stretch());
          };
        };
        // The relative error of nearly transparent pixels is that of single precision, too.
        const double scale = std::min(1.0, sigma_t * 40);
        // The ray ends at a transmittance of 1e-6, one of the two stated bounds.
        CHECK(worstOpacity(renderReference(grid, scene), scene, chordOpacity(box)) < scale * (kRounding + 1e-6));
        std::vector<ClipPlane> planes = box;
        scene.clipPlanes = {glm::dvec4(0.3, -0.5, 0.8, -glm::dot(glm::dvec3(0.3, -0.5, 0.8), scene.camera.lookAt) + 2)};
        scene.camera.nearDistance = 5.5;
        planes.push_back(scene.clipPlanes[0]);
        const glm::dvec3 forward = cameraFrame(camera).forward;
        planes.emplace_back(forward, -glm::dot(forward, camera.eye) - 5.5);
        CHECK(worstOpacity(renderReference(grid, scene), scene, chordOpacity(planes)) < scale * (kRounding + 1e-6));
      }
}

// A thousand cells have an optical depth of 1e-8 each. The opacity is that of their sum to 1e-6 of itself, since
// roundings do not add up.
TEST_CASE("Next to nothing in very many cells keeps its digits", "[reference]") {
  for (const double sigma_t : {1e-8, 1.3e-8, 1.7e-9, 1e-4}) {
    const ScalarGrid grid = fieldGrid(
        {glm::ivec3(0), glm::ivec3(4, 4, 1000)}, [](const glm::dvec3&) { return 1.0; }, glm::dmat4(1), 1);
    const ResolvedScene scene =
        plainScene(homogeneous(kAlbedo, sigma_t), orthographicCamera({2, 2, 1100}, {2, 2, 0}, 1, 1), 1);
    const ReferencePicture picture = renderReference(grid, scene);
    CHECK(picture.stats.cells >= 1000);
    const double alpha = -std::expm1(-sigma_t * 1000);
    CHECK(std::abs(picture.colour.at(0, 0)[3] / alpha - 1) < 1e-6);
    CHECK(std::abs(picture.colour.at(0, 0)[0] / (kAlbedo[0] * alpha) - 1) < 1e-6);
  }
}

// Interpolation adds f (1 - f) along each axis to the squared distance from the centre: 0 to 3/4 in all. With half of
// that taken off, the surface lies within 3/8 of a squared voxel of R^2, and so do the squares of half the chords.
TEST_CASE("A homogeneous sphere has the opacity of its chords", "[reference][slow]") {
  const double radius = 10, sigma_t = 0.09;
  const glm::dvec3 centre(12.3, 11.9, 12.1);
  const ScalarGrid grid = fieldGrid(
      kDomain, [&](const glm::dvec3& p) { return radius * radius - glm::dot(p - centre, p - centre) + 0.375; },
      glm::dmat4(1), -1000);
  for (const auto& [name, camera] : viewsOf(glm::dmat4(1))) {
    INFO(name);
    const ResolvedScene scene = plainScene(solidAbove(kAlbedo, sigma_t), camera, 1);
    const ReferencePicture picture = renderReference(grid, scene);
    double worst = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        const glm::dvec3 w = ray.direction / ray.stretch(), to = centre - ray.origin;
        const double along = glm::dot(to, w), across = glm::dot(to, to) - along * along;
        const auto opacity = [&](double squaredRadius) {
          const double reach = std::sqrt(std::max(0.0, squaredRadius - across));
          const double length = std::max(0.0, along + reach) - std::max(0.0, along - reach);
          return -std::expm1(-sigma_t * length);
        };
        const double low = opacity(radius * radius - 0.375), high = opacity(radius * radius + 0.375);
        const double alpha = picture.colour.at(x, y)[3];
        worst = std::max({worst, low - alpha, alpha - high});
      }
    CHECK(worst < 1e-6 + kRounding);
  }
}

// Trilinear interpolation reproduces a linear field exactly, and the optical depth of a linear extinction is that of
// the chord's middle.
TEST_CASE("A linear ramp of extinction has its exact optical depth", "[reference]") {
  for (const glm::dmat4& transform : {glm::dmat4(1), crookedTransform()})
    for (const auto& [name, camera] : viewsOf(transform)) {
      INFO(name << ", crooked " << (transform != glm::dmat4(1)));
      const auto value = [](const glm::dvec3& p) { return 0.05 + glm::dot(p, glm::dvec3(0.011, 0.004, 0.013)); };
      ResolvedScene scene = plainScene(TransferFunction({{0, {kAlbedo, 0}}, {1, {kAlbedo, 0.1}}}), camera, 1);
      const Box inner{glm::dvec3(2.3, 3.1, 2.7), glm::dvec3(20.6, 21.9, 22.2)};
      scene.clipPlanes = boxPlanes(inner, transform);
      const glm::dmat4 toIndex = glm::inverse(transform);
      const ScalarGrid grid = fieldGrid(kDomain, value, transform);
      // Voxels are single precision: 3e-8 of 1 over 70 world units of extinction 0.1 per unit of value.
      CHECK(worstOpacity(renderReference(grid, scene), scene, [&](const ViewRay& ray) {
              const DepthInterval kept = keptDepths(ray, scene.clipPlanes);
              if (!(kept.length() > 0)) return 0.0;
              const glm::dvec3 middle(toIndex * glm::dvec4(ray.at(kept.middle()), 1));
              return -std::expm1(-0.1 * value(middle) * kept.length() * ray.stretch());
            }) < 1e-6 + kRounding + 3e-7);
    }
}

// On a linear field the steps of the transfer function are exact planes, wherever they lie between voxels.
TEST_CASE("Two slabs blend in order, at their exact thickness", "[reference][slow]") {
  const TwoSlabs slabs;
  const ScalarGrid grid = fieldGrid(kDomain, [](const glm::dvec3& p) { return p.z; });
  for (const bool above : {false, true}) {
    const Camera camera = orthographicCamera({12, 9, above ? 60 : -50}, {12, 12, 12}, 8, 16);
    ResolvedScene scene = plainScene(slabs.transfer, camera, 1);
    scene.clipBox = Box{glm::dvec3(1), glm::dvec3(23)};  // beyond it, values fall back to the background's
    scene.ambient = {2, 0.5, 1};
    scene.background = glm::dvec3(0.25, 3, 0.125);
    const ReferencePicture picture = renderReference(grid, scene);
    const double stretch = 1 / std::abs(cameraFrame(camera).forward.z);
    const glm::dvec3 light = slabs.light(stretch, above);
    for (int c = 0; c < 3; ++c) {
      const double expected = light[c] * scene.ambient[c] + slabs.transmittance(stretch) * (*scene.background)[c];
      // The values of voxels are whole numbers, so only the picture's own rounding is left.
      for (const int pixel : {0, 7, 15})
        CHECK(std::abs(picture.colour.at(pixel, pixel)[c] - expected) < kRounding * std::max(1.0, expected));
    }
    CHECK(picture.colour.at(3, 3)[3] == 1);
  }
}

// In an opaque slab with an exponential profile the mean photon scatters at a depth of 1 / sigma_t below the surface.
TEST_CASE("Depth is the mean of what is seen", "[reference]") {
  const double sigma_t = 2;
  const ScalarGrid grid = fieldGrid(
      kDomain, [](const glm::dvec3&) { return 1.0; }, glm::dmat4(1), 1);
  ResolvedScene scene =
      plainScene(homogeneous(kAlbedo, sigma_t), orthographicCamera({12, 12, 50}, {12, 12, 0}, 8, 4), 1);
  const ReferencePicture picture = renderReference(grid, scene);
  // Rays end at a transmittance of 1e-6. What is left out lies 7 units deep, 33 from the eye.
  CHECK(*picture.depth.at(2, 2) == Approx(50 - 24 + 1 / sigma_t).margin(1e-6 * 34 + 26 * kRounding));
  scene.camera = orthographicCamera({100, 12, 50}, {100, 12, 0}, 8, 4);
  CHECK(std::isinf(*renderReference(grid, scene).depth.at(2, 2)));
}
