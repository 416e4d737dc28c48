// What an earlier study of the same scene measured, to be shown beside a new one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/scene/resolve.h"

namespace umbrick {
struct StudyRecord;

struct EarlierCase {
  std::string id, method;
  Model model = Model::emission;
  int size = 0;
  double theta = 0;      // rad; 0 for emission
  double timeRatio = 0;  // over the baseline of its own study
  double rmse = 0;
};

struct EarlierStudy {
  std::string name;                // of its file
  std::string version;             // of the program
  std::vector<EarlierCase> front;  // Pareto fronts, one after the other, cheapest first

  /// The cases of its fronts that are of the model and of the size and theta of the new study's base.
  std::vector<EarlierCase> comparable(const StudyRecord& record, Model model) const;
};

/// Reads a study.json of this or an earlier format, with whatever methods it has.
/// @param source  what messages call the text
/// @param record  the new study, with its extent
/// @throw IoError          not the record of a study, or damaged
/// @throw InvalidArgument  of another volume, scene, baseline or machine: names the first thing that differs
EarlierStudy readEarlierStudy(std::string_view text, const std::string& source, const StudyRecord& record);

}  // namespace umbrick
