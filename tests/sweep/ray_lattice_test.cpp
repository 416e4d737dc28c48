// Lattices of rays: that they are the view's own rays, and that they cover what is to be seen.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/ray_lattice.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "support/test_grids.h"
#include "support/test_scenes.h"

using namespace umbrick;

namespace {

const glm::dvec3 kLow(-1), kHigh(24);
const Box kVolume{kLow, kHigh};

glm::dvec3 unpermuted(const RayLattice& lattice, const glm::dvec3& p) {
  glm::dvec3 index;
  index[lattice.u] = p.x;
  index[lattice.v] = p.y;
  index[lattice.n] = p.z;
  return index;
}

// Returns how far a point of index space is from a ray of the camera, world units.
double distanceToRay(const glm::dvec3& index, const glm::dmat4& toWorld, const ViewRay& ray) {
  const glm::dvec3 world(toWorld * glm::dvec4(index, 1)), along = glm::normalize(ray.direction);
  const glm::dvec3 offset = world - ray.origin;
  return glm::length(offset - glm::dot(offset, along) * along);
}

}  // namespace

TEST_CASE("Rays of a lattice are those of the pixels", "[sweep]") {
  TestRandom random(17);
  int seen = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const glm::dmat4 toWorld = trial % 2 ? crookedTransform() : glm::dmat4(1);
    const glm::dvec3 middle(toWorld * glm::dvec4(11.5, 11.5, 11.5, 1));
    const glm::dvec3 eye = middle + random.uniform(0.2, 60) * random.point(glm::dvec3(-1), glm::dvec3(1));
    const glm::dvec3 lookAt = middle + random.point(glm::dvec3(-3), glm::dvec3(3));
    Camera camera = random.uniform() < 0.5 ? orthographicCamera(eye, lookAt, 40, 32)
                                           : perspectiveCamera(eye, lookAt, random.uniform(0.1, 2.6), 32);
    const IndexView view = indexView(camera, toWorld);
    LatticeOptions options;
    options.raysPerVoxel = random.uniform(0.5, 3);
    const std::vector<RayLattice> lattices = rayLattices(view, glm::dmat3(toWorld), kVolume, kLow, kHigh, options);
    for (const RayLattice& lattice : lattices)
      for (int i = 0; i < 20; ++i) {
        const double x = random.uniform(0, 32), y = random.uniform(0, 32);
        const glm::dvec2 p = glm::dvec2(x, y) * screenPlane(camera).pixelSize - screenPlane(camera).halfExtent;
        if (lattices.size() > 1 && !isMain(lattice, p)) continue;
        const glm::dvec3 at = lattice.placeOf(p);
        if (!(at.z > 0)) continue;  // the only lattice of a wide view, whose others see nothing
        const glm::dvec2 place = glm::dvec2(at) / at.z;
        const double n = lattice.reference;
        const glm::dvec2 across = lattice.start(n) + lattice.spacing(n) * place;
        CHECK(distanceToRay(unpermuted(lattice, {across, n}), toWorld, viewRay(camera, x, y)) <
              1e-9 * (1 + glm::length(eye)));
        CHECK(lattice.spacing(n).x > 0);
        CHECK(lattice.spacing(n).y > 0);
        ++seen;
      }
  }
  CHECK(seen > 1000);
}

TEST_CASE("Each point of the box that a pixel sees lies within a lattice", "[sweep]") {
  TestRandom random(23);
  int seen = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const glm::dmat4 toWorld = trial % 2 ? crookedTransform() : glm::dmat4(1);
    const glm::dvec3 middle(toWorld * glm::dvec4(11.5, 11.5, 11.5, 1));
    const glm::dvec3 eye = middle + random.uniform(0.2, 60) * random.point(glm::dvec3(-1), glm::dvec3(1));
    // What is visible may be larger than the volume, by bricks that reach beyond it, and so far that an eye beside the
    // volume lies between their faces.
    glm::dvec3 larger(0);
    if (trial % 2) larger[trial % 3] = 80;
    Camera camera = trial % 3 ? perspectiveCamera(eye, middle, random.uniform(0.3, 2.6), 32)
                              : orthographicCamera(eye, middle, 30, 32);
    const IndexView view = indexView(camera, toWorld);
    const std::vector<RayLattice> lattices =
        rayLattices(view, glm::dmat3(toWorld), kVolume, kLow - larger, kHigh + larger, {});
    for (int i = 0; i < 30; ++i) {
      const glm::dvec3 seenAt = view.toView(random.point(kLow, kHigh));
      if (seenAt.z <= 1e-3) continue;
      const glm::dvec2 p =
          camera.projection == Projection::perspective ? glm::dvec2(seenAt) / seenAt.z : glm::dvec2(seenAt);
      if (std::abs(p.x) > view.halfExtent.x || std::abs(p.y) > view.halfExtent.y) continue;
      bool found = false;
      for (const RayLattice& lattice : lattices) {
        if (lattices.size() > 1 && !isMain(lattice, p)) continue;
        const glm::dvec3 at = lattice.placeOf(p);
        if (!(at.z > 0)) continue;
        const glm::dvec2 place = glm::dvec2(at) / at.z;
        found = found || (place.x >= 1 && place.y >= 1 && place.x < lattice.width - 2 && place.y < lattice.height - 2);
      }
      CHECK(found);
      ++seen;
    }
  }
  CHECK(seen > 2000);
}

TEST_CASE("A view of more than its main axis' rays gets a lattice for each axis", "[sweep]") {
  const Camera narrow = perspectiveCamera({11, 12, 60}, {11, 12, 12}, 0.5, 32);
  CHECK(rayLattices(indexView(narrow, glm::dmat4(1)), glm::dmat3(1), kVolume, kLow, kHigh, {}).size() == 1);
  const Camera wide = perspectiveCamera({11, 12, 12}, {11, 12, 0}, 2.6, 32);
  CHECK(rayLattices(indexView(wide, glm::dmat4(1)), glm::dmat3(1), kVolume, kLow, kHigh, {}).size() == 5);
  // Nothing is in front of an eye that looks away.
  const Camera away = perspectiveCamera({11, 12, 60}, {11, 12, 99}, 0.5, 32);
  CHECK(rayLattices(indexView(away, glm::dmat4(1)), glm::dmat3(1), kVolume, kLow, kHigh, {}).empty());
}
