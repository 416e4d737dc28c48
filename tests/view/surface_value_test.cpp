// Values to begin with: of a surface that nobody has named, and of the axes of a function of gradients.
// SPDX-License-Identifier: Apache-2.0
#include "view/surface_value.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "view/gradient_histogram.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;

namespace {

ValueSurvey surveyOf(std::vector<double> histogram) {
  ValueSurvey survey;
  survey.low = 100;
  survey.high = 100 + static_cast<double>(histogram.size());
  survey.histogram = std::move(histogram);
  return survey;
}

// The variance that Otsu's method makes largest, from its definition.
double varianceAt(const ValueSurvey& survey, std::size_t edge) {
  double count[2]{}, sum[2]{};
  for (std::size_t bin = 0; bin < survey.histogram.size(); ++bin) {
    count[bin >= edge] += survey.histogram[bin];
    sum[bin >= edge] += survey.histogram[bin] * survey.binCentre(bin);
  }
  if (count[0] == 0 || count[1] == 0) return 0;
  const double mean = (sum[0] + sum[1]) / (count[0] + count[1]);
  double variance = 0;
  for (int part = 0; part < 2; ++part) variance += count[part] * std::pow(sum[part] / count[part] - mean, 2);
  return variance;
}

}  // namespace

TEST_CASE("Two peaks are parted in the middle of what is empty between them", "[view]") {
  std::vector<double> histogram(20, 0);
  histogram[2] = 50;
  histogram[13] = 5;
  CHECK(partingValue(surveyOf(histogram)) == Approx(100 + 0.5 * (3 + 13)));
}

TEST_CASE("No other edge of a histogram parts it better", "[view]") {
  std::vector<double> histogram;
  for (int i = 0; i < 64; ++i)
    histogram.push_back(1000 * std::exp(-0.02 * (i - 12) * (i - 12)) + 150 * std::exp(-0.005 * (i - 45) * (i - 45)));
  const ValueSurvey survey = surveyOf(histogram);
  const double value = partingValue(survey);
  const double found = varianceAt(survey, static_cast<std::size_t>(std::lround(value - survey.low)));
  for (std::size_t edge = 1; edge < 64; ++edge) CHECK(varianceAt(survey, edge) <= found * (1 + 1e-9));
  CHECK(value > 100 + 20);
  CHECK(value < 100 + 40);
}

TEST_CASE("A volume of one value still has a surface within its axis", "[view]") {
  const ValueSurvey survey = surveyOf({0, 7, 0, 0});
  CHECK(partingValue(survey) >= survey.low);
  CHECK(partingValue(survey) <= survey.high);
}

TEST_CASE("A ramp has one gradient, in grid units per world unit", "[view]") {
  // 3 a voxel along x, and voxels that are 2 world units long there.
  const ScalarGrid ramp = makeFilled({12, 12, 12}, {4, 5, 6}, [](const glm::ivec3& at) { return 1 + 3.0 * at.x; });
  const ScalarGrid grid = withTransform(ramp, glm::scale(glm::dmat4(1), glm::dvec3(2, 1, 1)));
  const GradientHistogram found = surveyGradients(grid, 1, 34);
  REQUIRE(found.counts.size() == static_cast<std::size_t>(found.values * found.gradients));
  CHECK(std::accumulate(found.counts.begin(), found.counts.end(), 0.0) == 12 * 12 * 12);
  // The faces are steeper; all that is inside is in the row of 1.5.
  CHECK(found.most > 1.5);
  const auto row = static_cast<std::size_t>(1.5 / found.most * found.gradients);
  const auto begin = found.counts.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(found.values));
  CHECK(std::accumulate(begin, begin + found.values, 0.0) >= 10 * 10 * 10);
}

TEST_CASE("A page that asks for gradients gets them once they are counted, and at once the next time", "[view]") {
  TemporaryFolder folder;
  Viewer viewer(testScene(), testVolume(), EngineKind::cpu, {.targetError = 0.05, .mostSamples = 4}, folder.path());
  const auto page = std::make_shared<NotingClient>();
  viewer.join(page);
  for (int time = 0; time < 2; ++time) {
    viewer.message(R"({"type": "gradients"})", page);
    const auto found = page->take("gradients");
    REQUIRE(found.is_object());
    CHECK(found["counts"].size() == found["values"].get<std::size_t>() * found["gradients"].get<std::size_t>());
    CHECK(found["most"] > 0);
  }
}

TEST_CASE("A lattice that a page makes of shapes comes back as it was sent, and is drawn", "[view]") {
  TemporaryFolder folder;
  Viewer viewer(testScene(), testVolume(), EngineKind::cpu, {.targetError = 0.05, .mostSamples = 4}, folder.path());
  const auto page = std::make_shared<NotingClient>();
  viewer.join(page);
  page->takeDone();
  // Numbers of seven digits, as the page rounds them: it knows its shapes again by them.
  const auto patch = nlohmann::ordered_json::parse(R"({"transfer": {"points": null,
    "values": [0.1234567, 0.5, 0.7654321, 1], "gradients": [0, 0.0123457],
    "albedo": [[0.9, 0.5, 0.123457], [0.9, 0.5, 0.1], [1, 1, 1], [0.3, 0.2, 0.1],
               [0.9, 0.5, 0.1], [0.9, 0.5, 0.1], [1, 1, 1], [0.3, 0.2, 0.1]],
    "sigma_t": [0, 0.333333, 0.25, 0, 0, 0.1, 0.7, 0]}})");
  viewer.message(nlohmann::ordered_json{{"type", "edit"}, {"patch", patch}}.dump(), page);
  const auto scene = page->take("scene")["scene"];
  for (const char* name : {"values", "gradients", "albedo", "sigma_t"})
    CHECK(nlohmann::json(scene["transfer"][name]) == nlohmann::json(patch["transfer"][name]));
  CHECK(page->takeDone()["samples"] > 0);
}
