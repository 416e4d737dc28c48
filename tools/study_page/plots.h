// Makes the plots of a study.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "study_page/plot_script.h"
#include "umbrick/study/study_record.h"

namespace umbrick::tools {

/// These two plots are of one model at the base size and theta.
Plot paretoPlot(const StudyRecord& record, Model model);       // error over time ratio, front marked
Plot convergencePlot(const StudyRecord& record, Model model);  // error over the distance of slices
/// Plots the error over the detail of the methods that have it, a line per number of slices.
Plot detailPlot(const StudyRecord& record, const StudyMethod::Detail& detail);

}  // namespace umbrick::tools
