// Writes the shell commands that make the pictures of a study again, and their errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/study/case_scene.h"

namespace umbrick::tools {

// The commands are run in the folder of the study, where scene.json is. Names of files there need no quotes.

/// @param scene  of studyScene, which is what scene.json holds
std::string renderCommand(const StudyCase& what, const ResolvedScene& scene, const StudyGeometry& geometry);
std::string referenceCommand(const StudyReference& what, const ResolvedScene& scene, const StudySettings& settings);
std::string compareCommand(const StudyCase& what, const StudyReference& reference);

}  // namespace umbrick::tools
