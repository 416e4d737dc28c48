// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers.h"
#include "study/invented_study.h"
#include "umbrick/study/earlier_study.h"
#include "umbrick/study/study_record.h"

namespace umbrick::fuzz {
namespace {

// As a study that goes on from its own record, and as one that is compared with another.
void patchedRecord(const std::filesystem::path&, std::string_view changes) {
  static const StudyRecord record = inventedStudy();
  static const std::string good = printRecord(record);
  const std::string text = patched(good, changes);
  StudyRecord restored = record;
  restored.references.clear();
  restored.modelErrors.clear();
  restored.cases.clear();
  try {
    restoreRecord(restored, text, "study.json");
  } catch (const Error&) {
  }
  readEarlierStudy(text, "study.json", record);
}

}  // namespace

std::map<std::string, NamedTarget> studyTargets() { return {{"study", {".json", patchedRecord}}}; }

}  // namespace umbrick::fuzz
