// The value of a surface that nobody has named.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/grid/value_survey.h"

namespace umbrick::view {

/// Returns the value that parts a histogram best in two: that of the largest variance between what lies below and what
/// lies above. Where a whole stretch of values does so, as an empty one between two peaks, its middle.
/// Source: Otsu 1979, doi:10.1109/TSMC.1979.4310076
double partingValue(const ValueSurvey& survey);

/// Returns the value of the surface to begin with: 0 of a level set, else partingValue().
double suggestSurface(const ScalarGrid& grid);

}  // namespace umbrick::view
