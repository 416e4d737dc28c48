// Makes the scenes that a study renders.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/reference/reference.h"
#include "umbrick/study/study_plan.h"

namespace umbrick {

/// Lengths of the volume that are measured before anything is drawn, world units.
struct StudyGeometry {
  double extent = 0;     // of what is visible, along the view axis
  double voxelEdge = 0;  // shortest edge of a voxel
};

/// Returns the scene of a study: without background radiance, with fixed values where the plan has its own.
/// @param resolved   see resolveScene
/// @param voxelEdge  shortest edge of a voxel, world units
ResolvedScene studyScene(const ResolvedScene& resolved, const StudyPlan& plan, double voxelEdge);

/// Returns what a case renders. @param scene  of studyScene
ResolvedScene caseScene(const ResolvedScene& scene, const StudyCase& what, const StudyGeometry& geometry);
/// Returns what a reference integrates. @param scene  of studyScene
ResolvedScene referenceScene(const ResolvedScene& scene, const StudyReference& what);
/// Returns the scene whose time is the unit of all times: emission with `kBaselineSlices`, 1 segment and 32 bits.
ResolvedScene baselineScene(const ResolvedScene& scene, int size, const StudyGeometry& geometry);
inline constexpr int kBaselineSlices = 256;

/// Returns the options that references are integrated with.
/// @param coarser  with half of the directions and four times the tolerance
ReferenceOptions referenceOptions(const StudySettings& settings, bool coarser = false);

}  // namespace umbrick
