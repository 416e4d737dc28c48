// The scenes of a study, and the commands that make their pictures again.
#pragma once
#include <string>

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
Scene studyScene(const Scene& resolved, const StudyPlan& plan, double voxelEdge);

/// @param scene  of studyScene
Scene caseScene(const Scene& scene, const StudyCase& what, const StudyGeometry& geometry);
Scene referenceScene(const Scene& scene, const StudyReference& what);
/// Emission with `kBaselineSlices`, 1 segment and 32 bits, what times are a multiple of.
Scene baselineScene(const Scene& scene, int size, const StudyGeometry& geometry);
inline constexpr int kBaselineSlices = 256;

/// @param coarser  with half of the directions and four times the tolerance
ReferenceOptions referenceOptions(const StudySettings& settings, bool coarser = false);

/// Commands for a shell in the folder of the report; file names of a study need no quotes.
std::string renderCommand(const StudyCase& what, const Scene& scene, const StudyGeometry& geometry);
std::string referenceCommand(const StudyReference& what, const Scene& scene, const StudySettings& settings);
std::string compareCommand(const StudyCase& what, const StudyReference& reference);

}  // namespace umbrick
