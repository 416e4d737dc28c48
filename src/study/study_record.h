// All that is known of a study: what it is of, where it ran, and what was measured so far. Kept as study.json.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/case_scene.h"
#include "study/earlier_study.h"
#include "study/error_measures.h"
#include "study/machine.h"
#include "study/statistics.h"
#include "study/volume_identity.h"
#include "umbrick/shade/slice_renderer.h"
#include "umbrick/study/study_plan.h"

namespace umbrick {

struct CaseResult {
  StudyCase what;
  double spacing = 0;                 // of slices, world units
  int segments = 1;                   // of a slab
  std::int64_t slicesDrawn = 0;       // between the nearest and the farthest visible brick
  ErrorMeasures error;                // against the reference of its model
  Spread timeRatio;                   // over the baseline
  double caseMs = 0, baselineMs = 0;  // medians
  int pairs = 0;                      // of which these are
  std::uint64_t bufferBytes = 0, textureBytes = 0;
  std::uint64_t fragments = 0;                       // of bricks that passed the depth test, all passes
  PassTimes passes;                                  // of one picture that waits for every pass and is not timed else
  double windowTexel = 0;                            // edge, world units; the windows of methods that have them
  std::uint64_t windowBytes = 0, windowUpdates = 0;  // bytes; texels that slices were taken through
  int directions = 0;                                // of the light
  double load = 0;                                   // 1-minute load average when it was timed
};

/// Of extinction, windows and eye: they sum up to 1.
std::array<double, 3> passShares(const PassTimes& passes);

struct ReferenceResult {
  StudyReference what;
  double integrateMs = 0;
  double timeRatio = 0;   // over the baseline of its size
  ErrorMeasures coarser;  // its difference to half of the directions and four times the tolerance
  bool operator==(const ReferenceResult&) const = default;
};

/// Reference `cone` against reference `ambient`.
struct ModelError {
  StudyReference cone;
  ErrorMeasures error;
};

struct StudyRecord {
  StudyPlan plan = {};
  ResolvedScene scene;  // what the plan sweeps has a fixed value
  VolumeIdentity volume = {};
  Machine machine = {};
  StudyGeometry geometry = {};
  std::vector<ReferenceResult> references = {};
  std::vector<ModelError> modelErrors = {};
  std::vector<CaseResult> cases = {};
  std::optional<EarlierStudy> earlier = {};  // shown beside, no part of the study

  bool complete() const;
  const CaseResult* find(const StudyCase& what) const;
  const ReferenceResult* find(const StudyReference& what) const;
  const ModelError* findModelError(const StudyReference& cone) const;
};

/// JSON; parseRecord reads back the same.
std::string printRecord(const StudyRecord& record);
/// Takes over what was measured from the text of a study.json.
/// @param record  what is to be studied
/// @param source  what messages call the text
/// @throw IoError          not a study.json, or damaged
/// @throw InvalidArgument  of another study: names the first setting that differs, there and here; or unfinished and
///                         of another machine
void restoreRecord(StudyRecord& record, std::string_view text, const std::string& source);

}  // namespace umbrick
