// SPDX-License-Identifier: Apache-2.0
#include "view/surface_value.h"

#include <numeric>

namespace umbrick::view {

double partingValue(const ValueSurvey& survey) {
  const std::vector<double>& histogram = survey.histogram;
  const double all = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  double whole = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) whole += histogram[bin] * survey.binCentre(bin);
  double below = 0, sum = 0, best = 0;
  // The best places are edges between bins: from the first to the last with the largest variance.
  std::size_t first = histogram.size() / 2, last = first;
  for (std::size_t edge = 1; edge < histogram.size(); ++edge) {
    below += histogram[edge - 1];
    sum += histogram[edge - 1] * survey.binCentre(edge - 1);
    const double above = all - below;
    if (!(below > 0) || !(above > 0)) continue;
    const double apart = sum / below - (whole - sum) / above;
    const double variance = below * above * apart * apart;
    constexpr double kRounding = 1e-9;
    if (variance > best * (1 + kRounding)) {
      best = variance;
      first = last = edge;
    } else if (variance > best * (1 - kRounding) && last + 1 == edge) {
      last = edge;
    }
  }
  return survey.low + 0.5 * static_cast<double>(first + last) * survey.binWidth();
}

double suggestSurface(const ScalarGrid& grid) { return grid.isLevelSet() ? 0.0 : partingValue(surveyValues(grid)); }

}  // namespace umbrick::view
