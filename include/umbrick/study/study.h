// A study tells what accuracy costs. It renders every case of a plan, times it, compares it, and keeps
// what was measured.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "umbrick/gl/context.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/image/image.h"
#include "umbrick/study/study_plan.h"
#include "umbrick/study/study_record.h"

namespace umbrick {

struct StudyProgress {
  double share = 0;  // estimated share of the work that was left when this run began, in [0, 1]
  std::string step;  // what is done now
  std::size_t casesDone = 0, cases = 0;
};

/// A picture at the moment when it is measured. A study keeps only the pictures of its references: a caller that wants
/// to show the others takes them from here.
struct StudyPicture {
  std::string id;                // id of the case or of the reference
  Model model;                   // the model that the picture is of, or approximates
  const Image& image;            // linear premultiplied RGBA; valid during the call, as is `truth`
  const Image* truth = nullptr;  // what its error is measured against; null: compared with nothing
};

struct StudyOptions {
  /// Is called often; false stops after the case at hand, and within a reference.
  std::function<bool(const StudyProgress&)> progress = {};
  /// Is called before the record says that a picture is measured, so that a study which ends here by an exception
  /// measures the picture again when it goes on. It is called for every reference and case, and once more for a
  /// reference of the cone at the base size, whose truth is then the reference of the whole sphere.
  std::function<void(const StudyPicture&)> picture = {};
  /// The study.json of an earlier study of the same scene on the same machine, whose Pareto fronts are shown beside the
  /// new ones. It may be of an earlier version. Empty: there is none.
  std::filesystem::path earlier = {};
  /// Name and version of the program with which the caller draws plots, for the record.
  std::string plotter = {};
};

struct StudyOutcome {
  StudyRecord study;  // all that is measured; where it is not complete the same call goes on with it
  std::filesystem::path table = {}, record = {};  // CSV, JSON
  std::uint64_t nonFiniteVoxels = 0;  // active NaN or infinite voxels, read as background; 0 when nothing was measured
};

/// Measures the cases of a plan that are not in the folder yet, and writes what it measured there:
///   study.csv, study.json a row and an object per case; study.json is also what a stopped study goes on from
///   scene.json            the scene that all cases and references vary
///   references/           pictures of the references, EXR
/// A folder that holds the same study goes on: finished references and cases are kept. A complete study is not measured
/// again: only the table is written anew.
///
/// About time: case and baseline take turns in one process, after a picture of each that does not count; a case's time
/// is the median of the ratios of neighbours. The baseline is `emission` with 256 slices, one segment and a 32-bit
/// buffer, at the size of the case.
///
/// About error: it is that of linear premultiplied RGB without background radiance, against the reference of the same
/// model, size and theta. The error of a reference is estimated as its difference to one with half of the directions
/// and four times the tolerance.
///
/// @param scene   resolved; its model, method, background and what a plan sweeps do not matter
/// @param folder  new, empty, or of the same study
/// @throw InvalidArgument  see planStudy; the earlier study is of another volume, scene, baseline or machine; the
///   volume is empty or invisible; slices are so far apart that bricks are too narrow; the folder holds another study
///   (the message names what differs) or anything else, and is left untouched
/// @throw IoError  a file of the folder is damaged or cannot be written
/// @throw GlError
/// @pre `context` is current
StudyOutcome runStudy(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                      const StudySettings& settings, const std::filesystem::path& folder,
                      const StudyOptions& options = {});

}  // namespace umbrick
