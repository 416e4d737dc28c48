// A record holds all that is known of a study: what it is of, where it ran, and what was measured so far. It is
// kept as study.json.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/shade/slice_renderer.h"
#include "umbrick/study/case_scene.h"
#include "umbrick/study/earlier_study.h"
#include "umbrick/study/error_measures.h"
#include "umbrick/study/machine.h"
#include "umbrick/study/statistics.h"
#include "umbrick/study/study_plan.h"
#include "umbrick/study/volume_identity.h"

namespace umbrick {

/// What was measured of one case.
struct CaseResult {
  StudyCase what;
  double spacing = 0;                 // distance of slices, world units
  int segments = 1;                   // segments of a slab
  std::int64_t slicesDrawn = 0;       // slices between the nearest and the farthest visible brick
  ErrorMeasures error;                // against the reference of its model
  Spread timeRatio;                   // time over the baseline
  double caseMs = 0, baselineMs = 0;  // medians
  double lightMs = 0;                 // to compute a light volume, once, which the times above leave out
  int pairs = 0;                      // timed pairs that the medians are of
  std::uint64_t bufferBytes = 0, textureBytes = 0;
  std::uint64_t fragments = 0;                       // of bricks that passed the depth test, in all passes
  PassTimes passes;                                  // of one picture that waits for each pass
  double windowTexel = 0;                            // edge of a texel of the light windows, world units; 0: no windows
  std::uint64_t windowBytes = 0, windowUpdates = 0;  // bytes; texels that light was taken through slices in
  int directions = 0;                                // directions of the light
  double load = 0;                                   // 1-minute load average when the case was timed
};

/// Returns the time over the baseline of a picture whose light is computed for it.
double timeWithLight(const CaseResult& result);

/// Returns the shares of extinction, windows and eye in the time of a picture; they add up to 1.
std::array<double, 3> passShares(const PassTimes& passes);

/// What was measured of one reference; its picture is a file of the study's folder.
struct ReferenceResult {
  StudyReference what;
  double integrateMs = 0;
  double timeRatio = 0;   // time over the baseline of its size
  ErrorMeasures coarser;  // its difference to a reference with half of the directions and four times the tolerance
  bool operator==(const ReferenceResult&) const = default;
};

/// The difference of reference `cone` to reference `ambient`.
struct ModelError {
  StudyReference cone;
  ErrorMeasures error;
};

struct StudyRecord {
  StudyPlan plan = {};  // what is to be measured; the other members say where, and what is measured already
  ResolvedScene scene;  // has a fixed value where the plan sweeps
  VolumeIdentity volume = {};
  Machine machine = {};
  StudyGeometry geometry = {};
  std::vector<ReferenceResult> references = {};
  std::vector<ModelError> modelErrors = {};
  std::vector<CaseResult> cases = {};
  std::optional<EarlierStudy> earlier = {};  // shown beside the study, and no part of it

  /// Tells whether every case and every reference of the plan is measured.
  bool complete() const;
  /// Returns the result of a case; null when it is not measured.
  const CaseResult* find(const StudyCase& what) const;
  const ReferenceResult* find(const StudyReference& what) const;
  const ModelError* findModelError(const StudyReference& cone) const;
};

/// Returns JSON, the text of study.json, which restoreRecord reads back.
std::string printRecord(const StudyRecord& record);
/// Takes over what was measured from the text of a study.json.
/// @param record  what is to be studied
/// @param source  what messages call the text
/// @throw IoError          the text is not a study.json, or damaged
/// @throw InvalidArgument  the text is of another study (the message names the first setting that differs, there and
///   here), or unfinished and of another machine
void restoreRecord(StudyRecord& record, std::string_view text, const std::string& source);

}  // namespace umbrick
