// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/patient_space.h"

#include <catch2/catch.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

using namespace umbrick;

TEST_CASE("Letters of a space say where the axes of the world point", "[core]") {
  const auto lps = patientAxes("LPS"), ras = patientAxes("RAS"), sar = patientAxes("SAR");
  REQUIRE((lps && ras && sar));
  CHECK(lps->left == glm::dvec3(1, 0, 0));
  CHECK(ras->left == glm::dvec3(-1, 0, 0));
  CHECK(ras->posterior == glm::dvec3(0, -1, 0));
  CHECK(ras->superior == glm::dvec3(0, 0, 1));
  CHECK(sar->superior == glm::dvec3(1, 0, 0));
  CHECK(sar->left == glm::dvec3(0, 0, -1));
  for (const char* other : {"", "LP", "LPSS", "LLS", "LRS", "lps", "scanner-xyz", "XYZ", "APS"}) {
    CAPTURE(other);
    CHECK(!patientAxes(other));
    CHECK(!changeOfSpace(other, "LPS"));
    CHECK(!changeOfSpace("LPS", other));
  }
}

// nibabel.orientations: LPS to RAS is the diagonal -1 -1 1.
TEST_CASE("A change of space and the way back are the identity, over all 48 spaces", "[core]") {
  CHECK(*changeOfSpace("LPS", "RAS") == glm::dmat4(glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1)));
  std::vector<std::string> spaces;
  for (const char* letters : {"LPS", "LSP", "PLS", "PSL", "SLP", "SPL"})
    for (int signs = 0; signs < 8; ++signs) {
      std::string space = letters;
      for (char& letter : space) {
        if (letter == 'L' && signs & 1) letter = 'R';
        if (letter == 'P' && signs & 2) letter = 'A';
        if (letter == 'S' && signs & 4) letter = 'I';
      }
      spaces.push_back(space);
    }
  for (const std::string& a : spaces)
    for (const std::string& b : spaces) {
      const auto there = changeOfSpace(a, b), back = changeOfSpace(b, a);
      REQUIRE((there && back));
      CHECK(*back * *there == glm::dmat4(1));
      CHECK(*there * glm::dvec4(patientAxes(a)->left, 0) == glm::dvec4(patientAxes(b)->left, 0));
    }
}
