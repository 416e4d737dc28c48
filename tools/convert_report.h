// What umbrick convert prints about a file that it wrote.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"
#include "umbrick/convert/plan_volumes.h"

namespace umbrick::tools {

/// What was lost in each grid, on stdout.
/// @param options  that it was converted with
void printReport(const ConvertReport& report, const ConvertOptions& options);

/// One line about a frame that is written, on stdout.
void printFrame(const ConvertReport& report);

/// What a user should know of how the volumes were read, on stderr.
/// @param said  notes that are not said again, as those of frames before; may be null
void printNotes(const ConvertReport& report, std::set<std::string>* said = nullptr);

/// Grids that were left out, and options that did not apply, on stderr.
void printWarnings(const ConvertReport& report);

/// What a user should see in the numbers of a grid: nothing is left, or so much that another background would leave it
/// out. Empty: nothing. Options have the words of the command line.
std::string usualLine(const ConvertedGrid& grid);
/// Which options did not apply to a level set. Empty: all did.
std::string keptLine(const ConvertedGrid& grid);

/// What a volume would become, on stdout.
/// @param codec  of the .vdb
void printPlan(const VolumePlan& plan, VdbCodec codec);

/// The background that the border of a volume gave, on stdout.
void printBackground(const BorderMode& mode);

}  // namespace umbrick::tools
