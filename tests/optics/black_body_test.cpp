// Colours of black bodies against tables.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "umbrick/optics/black_body.h"

using namespace umbrick;

TEST_CASE("Chromaticities of black bodies are those of tables", "[optics]") {
  // Wyszecki and Stiles, Color Science, 2nd ed., the Planckian locus of the 2-degree observer.
  struct Row {
    double kelvin, x, y;
  };
  double worst = 0;
  for (const Row& row : {Row{1000, 0.6528, 0.3444}, Row{1500, 0.5857, 0.3931}, Row{2000, 0.5267, 0.4133},
                         Row{2500, 0.4770, 0.4137}, Row{3000, 0.4369, 0.4041}, Row{4000, 0.3805, 0.3768},
                         Row{5000, 0.3451, 0.3516}, Row{6500, 0.3135, 0.3237}, Row{10000, 0.2807, 0.2884}}) {
    const glm::dvec3 xyz = blackBodyXyz(row.kelvin);
    const double sum = xyz.x + xyz.y + xyz.z,
                 off = std::max(std::abs(xyz.x / sum - row.x), std::abs(xyz.y / sum - row.y));
    INFO(row.kelvin << " K: x " << xyz.x / sum << ", y " << xyz.y / sum << ", in the table " << row.x << ", " << row.y);
    CHECK(off < (row.kelvin < 1500 ? 0.011 : 0.006));  // what black_body.h promises of the fit
    worst = std::max(worst, off);
  }
  INFO("largest difference " << worst);
  CHECK(worst > 1e-4);  // a fit and no table
}

TEST_CASE("Platinum that freezes has the luminance by which the candela was defined", "[optics]") {
  // 60 cd/cm^2 at 2041.4 K (ITS-90), CGPM 1948; 683 lm/W is today's definition of the same unit.
  CHECK(683 * blackBodyXyz(2041.4).y == Approx(6.0e5).epsilon(0.02));  // the fit of y, and two rounded constants
}

TEST_CASE("Black bodies glow from red over white to blue, at luminance 1", "[optics]") {
  double before = 0;
  for (const double kelvin : {800.0, 1000.0, 1500.0, 2000.0, 3000.0, 5000.0, 6500.0, 9000.0, 15000.0}) {
    const glm::dvec3 colour = blackBodyColour(kelvin);
    INFO(kelvin << " K: " << colour.r << " " << colour.g << " " << colour.b);
    CHECK(glm::dot(colour, glm::dvec3(0.2126729, 0.7151522, 0.0721750)) == Approx(1));
    CHECK(std::min({colour.r, colour.g, colour.b}) >= 0);
    CHECK(colour.b / colour.r >= before);
    before = colour.b / colour.r;
  }
  // White of sRGB is D65, which is near a black body of 6500 K, a little greener.
  const glm::dvec3 white = blackBodyColour(6500);
  CHECK(glm::length(white - glm::dvec3(1)) < 0.1);
}
