// Writes study.csv, which has a row per case.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/study/study_record.h"

namespace umbrick {

/// Returns comma-separated values: the first line has the names of the columns, the rows are in the order of the plan.
/// A cell is empty where a method does not have such a number. Times are multiples of the baseline; milliseconds are
/// there only where OpenGL does not run in software.
std::string printTable(const StudyRecord& record);

}  // namespace umbrick
