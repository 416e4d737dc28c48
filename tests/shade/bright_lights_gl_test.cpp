// Light brighter than 1 reaches the picture.
// SPDX-License-Identifier: Apache-2.0
#include "shade/hard_case.h"

using namespace umbrick;

namespace {

ResolvedScene brightScene(const glm::dvec3& radiance, int bits) {
  ResolvedScene scene = plainScene(ramp(2), smallCameras()[1], 0.5);
  scene.model = Model::lights;
  scene.method = Method::ordinates;
  scene.lights = {{LightFrame::view, ConeLight{{0, 0, 1}, 0, radiance}}};
  scene.sampling.bits = bits;
  return scene;
}

}  // namespace

TEST_CASE("A picture is as many times brighter as its light, with 16 bits too", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs);
  const glm::dvec3 tint(1, 0.8, 0.6);
  const Image dim = renderGrid(*context, grid, brightScene(tint * 0.5, 32)).colour;
  CHECK(largestAlpha(dim) > 0.9);
  for (const int bits : {32, 16})
    for (const double times : {2.0, 10.0, 5000.0}) {
      INFO(bits << " bits, " << times << " times");
      const Image bright = renderGrid(*context, grid, brightScene(tint * (0.5 * times), bits)).colour;
      double most = 0;
      for (std::size_t i = 0; i < dim.pixels.size(); ++i) {
        const bool alpha = i % 4 == 3;
        most = std::max(most, std::abs(bright.pixels[i] / (alpha ? 1 : times) - static_cast<double>(dim.pixels[i])));
      }
      // On each of some 60 slabs, 16 bits are rounded by up to 2.3e-5 of the brightest light.
      CHECK(most < (bits == 32 ? 1e-5 : 60 * 2.3e-5));
    }
}
