// Reads what an earlier study of the same scene measured, to be shown beside a new one.
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
  double timeRatio = 0;  // time over the baseline of its own study
  double rmse = 0;
};

struct EarlierStudy {
  std::string name;                // name of its file
  std::string version;             // version of the program
  std::vector<EarlierCase> front;  // Pareto fronts, one after the other, cheapest first

  /// Returns the cases of its fronts that have the model, and the size and theta of the new study's base.
  std::vector<EarlierCase> comparable(const StudyRecord& record, Model model) const;
};

/// Reads a study.json of this or an earlier format, whatever methods it has.
/// @param source  what messages call the text
/// @param record  the new study, with its extent
/// @throw IoError          the text is not the record of a study, or damaged
/// @throw InvalidArgument  the study is of another volume, scene, baseline or machine; the message names the first
///   thing that differs
EarlierStudy readEarlierStudy(std::string_view text, const std::string& source, const StudyRecord& record);

}  // namespace umbrick
