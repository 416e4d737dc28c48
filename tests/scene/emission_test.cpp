// Light that a second grid gives off, as a function of its values.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <string>

#include "support/complaint.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/optics/black_body.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/emission.h"

using namespace umbrick;

namespace {

double luminanceOf(const glm::dvec3& colour) { return glm::dot(colour, glm::dvec3(0.2126729, 0.7151522, 0.0721750)); }

}  // namespace

TEST_CASE("Black bodies emit their colour, as bright as the temperature says", "[scene][emission]") {
  EmissionSettings settings;
  settings.scale = 2000;
  settings.offset = 300;
  settings.intensity = 3;
  for (const auto& [name, brightness] : kEmissionBrightnesses) {
    settings.brightness = brightness;
    const TransferFunction emitted = emissionFunction(settings);
    CHECK(emitted((480 - 300) / 2000.0).sigma_t == 0);
    for (const double kelvin : {1003.3, 1234.5, 1777.7, 2500.1, 4321.0, 9876.5}) {
      INFO(name << ", " << kelvin << " K");
      const glm::dvec3 light = emitted((kelvin - 300) / 2000).sigma_s();
      const double expected = brightness == EmissionBrightness::constant ? 1
                              : brightness == EmissionBrightness::planck ? blackBodyXyz(kelvin).y / blackBodyXyz(1500).y
                                                                         : std::pow(kelvin / 1500, 4);
      CHECK(luminanceOf(light) == Approx(3 * expected).epsilon(0.004));  // as emission.h promises
      CHECK(glm::length(light / luminanceOf(light) - blackBodyColour(kelvin)) <
            0.004 * glm::length(blackBodyColour(kelvin)));
    }
    CHECK(luminanceOf(emitted((1500 - 300) / 2000.0).sigma_s()) == Approx(3).epsilon(0.004));
    // What is hotter than the hottest is as bright as that.
    CHECK(emitted(1e6) == emitted((kEmissionHottest - 300) / 2000));
  }
}

TEST_CASE("A table is looked up at scale times the value plus offset, times the intensity", "[scene][emission]") {
  EmissionSettings settings;
  settings.kind = EmissionKind::table;
  settings.table = TransferFunction({{1, {{1, 0.5, 0.25}, 0}}, {3, {{1, 0.5, 0.25}, 4}}});
  settings.scale = 2;
  settings.offset = -1;
  settings.intensity = 10;
  const TransferFunction emitted = emissionFunction(settings);
  for (const double value : {0.9, 1.0, 1.25, 1.7, 2.0, 2.5})
    CHECK(glm::length(emitted(value).sigma_s() - 10.0 * (*settings.table)(2 * value - 1).sigma_s()) < 1e-12);
  settings.table.reset();
  CHECK(complaint<InvalidArgument>([&] { emissionFunction(settings); }).find("emission.transfer, which is missing") !=
        std::string::npos);
}

TEST_CASE("Emission is written and read, and is that of modes with a medium", "[scene][emission]") {
  Scene scene;
  scene.transfer = homogeneous(glm::dvec3(0.5), 1);
  CHECK(printScene(scene).find("brightness") == std::string::npos);
  scene.volume.file = "fire.vdb";
  scene.volume.emissionGrid = "flame";
  scene.emission.kind = EmissionKind::table;
  scene.emission.table = homogeneous({1, 0.4, 0.1}, 2);
  scene.emission.intensity = 0.125;
  CHECK(parseScene(printScene(scene), "printed") == scene);
  CHECK(emits(scene));
  CHECK(resolveScene(scene, {glm::dvec3(0), glm::dvec3(1)}, glm::dmat4(1)).emitted.has_value());
  for (const Mode mode : {Mode::mip, Mode::minip, Mode::average, Mode::xray, Mode::isosurface}) {
    scene.mode = mode;
    CHECK_FALSE(emits(scene));
  }
  scene.mode = Mode::integrate;
  scene.volume.emissionGrid = std::string(kAutomaticGrid);  // none is found yet
  CHECK_FALSE(emits(scene));
}

TEST_CASE("An emission that fills all of space is refused with both values", "[scene][emission]") {
  EmissionSettings settings;
  settings.offset = 1500;
  const std::string said = complaint<InvalidArgument>([&] { requireDarkBackground(emissionFunction(settings), 0.25); });
  CHECK(said.find("0.25") != std::string::npos);
  CHECK(said.find("emission.offset") != std::string::npos);
  settings.offset = 273.15;
  CHECK_NOTHROW(requireDarkBackground(emissionFunction(settings), 0));
}
