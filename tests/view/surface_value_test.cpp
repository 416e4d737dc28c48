// The value of a surface that nobody has named.
// SPDX-License-Identifier: Apache-2.0
#include "view/surface_value.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "support/test_grids.h"
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

