// index.html: the study for a reader, in one file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "study_page/page_folder.h"
#include "study_page/page_parts.h"
#include "umbrick/study/study_findings.h"
#include "umbrick/study/study_record.h"

namespace umbrick::tools {

/// Draws the plots, then writes the page with all that it shows inside. An unfinished study says so.
/// @throw IoError
void writePage(const StudyRecord& record, const PageFolder& folder);

// --- sections, each a piece of HTML; empty where there is nothing to tell ---

/// A case in words: "dos, Algorithm 3, n = 3, 256 slices"; what is at the base is left out, slices and detail are not.
std::string describeCase(const StudyCase& what, const StudyPlan& plan);
/// "2 segments per slab"
std::string describeSegments(int segments);

std::string frontTable(const StudyRecord& record, const ComparableCases& group);
/// The front of the earlier study beside.
std::string earlierTable(const StudyRecord& record, Model model);
std::string aroundBaseTable(const StudyRecord& record);
std::string modelErrorTable(const StudyRecord& record);
/// Methods with windows (ordinates) beside those without (dos).
std::string comparisonTables(const StudyRecord& record, const std::vector<ComparableCases>& groups);
/// What windows take in memory and in time.
std::string windowTable(const StudyRecord& record);
std::string caseTable(const StudyRecord& record, const std::vector<ComparableCases>& groups);
std::string referenceTable(const StudyRecord& record);

/// Reference, case and error of the front of the base groups; and cone, ambient and error of the models.
std::string casePictures(const StudyRecord& record, const PageFolder& folder, const ComparableCases& group);
std::string modelPictures(const StudyRecord& record, const PageFolder& folder);

std::string commandList(const StudyRecord& record);

}  // namespace umbrick::tools
