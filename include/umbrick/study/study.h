// A study: what accuracy costs. Renders every case of a plan, times it, compares it, and writes a report.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "umbrick/gl/context.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/study/study_plan.h"

namespace umbrick {

struct StudyProgress {
  double share = 0;  // of the work that was left when this run began, estimated, in [0, 1]
  std::string step;  // what is done now
  std::size_t casesDone = 0, cases = 0;
};

struct StudyOutcome {
  bool complete = false;  // false: stopped; the same call goes on
  std::size_t casesDone = 0, cases = 0;
  std::filesystem::path page, table, record;  // HTML, CSV, JSON
  std::uint64_t nonFiniteVoxels = 0;  // active NaN or infinite voxels, read as background; 0 when nothing was measured
};

/// Measures the cases of a plan that are not in the folder yet, and writes the report:
///   index.html            plots, table, pictures, machine, commands: one file that needs nothing else
///   study.csv, study.json a row and an object per case; study.json is also what a stopped study goes on from
///   scene.json            what the commands of the page render
///   references/, pictures/, plots/    EXR; PNG of each case and of its error; SVG with gnuplot's script and data
/// A folder that holds the same study goes on: finished references and cases are kept. A complete one is not measured
/// again: only the page, the table and the plots are written anew.
///
/// Time: case and baseline take turns in one process, after a picture of each that does not count; a case's time is
/// the median of the ratios of neighbours. The baseline is `emission` with 256 slices, one segment and a 32-bit buffer,
/// at the size of the case. Error: of linear premultiplied RGB without background radiance, against the reference of
/// the same model, size and theta. The error of a reference is estimated as its difference to one with half of the
/// directions and four times the tolerance.
///
/// @param scene     resolved; its model, method, background and what a plan sweeps do not matter
/// @param progress  called often; false stops after the case at hand, and within a reference
/// @param earlier   study.json of an earlier study of the same scene on the same machine, whose Pareto fronts the page
///                  shows beside; may be of an earlier version; empty: none
/// @throw InvalidArgument  see planStudy; an earlier study of another volume, scene, baseline or machine; an empty or
/// invisible volume; slices so far apart that bricks are too narrow;
///                         a folder that holds another study (names what differs) or anything else: untouched then
/// @throw IoError  gnuplot is missing or fails, a file of the folder is damaged or cannot be written
/// @throw GlError
/// @pre `context` is current
StudyOutcome runStudy(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                      const StudySettings& settings, const std::filesystem::path& folder,
                      const std::function<bool(const StudyProgress&)>& progress = {},
                      const std::filesystem::path& earlier = {});

}  // namespace umbrick
