// The scenes that a study renders.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/reference/reference.h"
#include "umbrick/study/study_plan.h"

namespace umbrick {

/// What is measured of the volume before anything is drawn, world units.
struct StudyGeometry {
  double extent = 0;     // of what is visible, along the view axis
  double voxelEdge = 0;  // the shortest
};

/// What a study of the scene is of: without background radiance, with fixed values where the plan has its own.
/// @param resolved   see resolveScene
/// @param voxelEdge  the shortest, world units
ResolvedScene studyScene(const ResolvedScene& resolved, const StudyPlan& plan, double voxelEdge);

/// What a case renders. @param scene  of studyScene
ResolvedScene caseScene(const ResolvedScene& scene, const StudyCase& what, const StudyGeometry& geometry);
/// What a reference integrates. @param scene  of studyScene
ResolvedScene referenceScene(const ResolvedScene& scene, const StudyReference& what);
/// Emission with `kBaselineSlices`, 1 segment and 32 bits, what times are a multiple of.
ResolvedScene baselineScene(const ResolvedScene& scene, int size, const StudyGeometry& geometry);
inline constexpr int kBaselineSlices = 256;

/// With what care references are integrated. @param coarser  with half of the directions and four times the tolerance
ReferenceOptions referenceOptions(const StudySettings& settings, bool coarser = false);

}  // namespace umbrick
