// study.csv: a row per case.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "study/study_record.h"

namespace umbrick {

/// Comma-separated, first line the names of the columns, in the order of the plan. What a method does not have is
/// empty. Times are ratios; milliseconds only where OpenGL is no software.
std::string printTable(const StudyRecord& record);

}  // namespace umbrick
