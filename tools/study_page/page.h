// Writes index.html, which shows a study to a reader, in one file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "study_page/page_folder.h"
#include "study_page/page_parts.h"
#include "umbrick/study/study_findings.h"
#include "umbrick/study/study_record.h"

namespace umbrick::tools {

/// Draws the plots, then writes the page with everything that it shows inside. The page of an unfinished study says
/// that it is one.
/// @throw IoError
void writePage(const StudyRecord& record, const PageFolder& folder);

// --- sections, each a piece of HTML; empty where there is nothing to tell ---

/// Describes a case: "dos, Algorithm 3, n = 3, 256 slices"; what is at the base is left out, except slices and detail.
std::string describeCase(const StudyCase& what, const StudyPlan& plan);
/// Returns "2 segments per slab" and the like.
std::string describeSegments(int segments);

std::string frontTable(const StudyRecord& record, const ComparableCases& group);
/// Returns the front of the earlier study, to be shown beside the new one.
std::string earlierTable(const StudyRecord& record, Model model);
std::string aroundBaseTable(const StudyRecord& record);
std::string modelErrorTable(const StudyRecord& record);
/// Compares methods with windows (ordinates) with methods without (dos).
std::string comparisonTables(const StudyRecord& record, const std::vector<ComparableCases>& groups);
/// Returns what windows take in memory and in time.
std::string windowTable(const StudyRecord& record);
/// Says which method is the fastest for which error, and what it takes in memory. Empty for fewer than two methods.
std::string whichWhenTables(const StudyRecord& record, const std::vector<ComparableCases>& groups);
/// Shows the looks other than that of the medium: a table of the techniques that have it, with time, error and memory,
/// and their pictures. Empty where a study has none of them.
std::string modeSections(const StudyRecord& record, const PageFolder& folder,
                         const std::vector<ComparableCases>& groups);
std::string caseTable(const StudyRecord& record, const std::vector<ComparableCases>& groups);
std::string referenceTable(const StudyRecord& record);

/// Returns reference, case and error of the front of the base groups; and cone, ambient and error of the models.
std::string casePictures(const StudyRecord& record, const PageFolder& folder, const ComparableCases& group);
std::string modelPictures(const StudyRecord& record, const PageFolder& folder);

/// Returns reference, picture and error of each method of the base groups, at one error that most of them reach.
std::string methodPictures(const StudyRecord& record, const PageFolder& folder,
                           const std::vector<ComparableCases>& groups);

/// Returns reference, picture and error of the finest case of each method of a group.
std::string lookPictures(const StudyRecord& record, const PageFolder& folder, const ComparableCases& group);

std::string commandList(const StudyRecord& record);

}  // namespace umbrick::tools
