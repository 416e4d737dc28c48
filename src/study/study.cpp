// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study.h"

#include "core/text_file.h"
#include "study/case_scene.h"
#include "study/gnuplot.h"
#include "study/page.h"
#include "study/study_run.h"
#include "study/study_table.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

StudyOutcome runStudy(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                      const StudySettings& settings, const std::filesystem::path& root,
                      const std::function<bool(const StudyProgress&)>& progress, const std::filesystem::path& earlier) {
  // Everything that can be refused is refused before anything is written.
  const StudyPlan plan = planStudy(settings, scene.occlusion.aperture);
  validateScene(scene);
  const double voxelEdge = shortestVoxelEdge(grid.indexToWorld());
  StudyRecord record{.plan = plan, .scene = studyScene(scene, plan, voxelEdge)};
  record.geometry.voxelEdge = voxelEdge;
  record.volume = identify(scene.volume.file);
  record.scene.volume.file = record.volume.file;
  record.machine = describeMachine(context, gnuplotVersion());
  record.geometry.extent = visibleExtent(context, grid, record.scene);
  // Again, now that it is known how few slices can be drawn.
  const int least = leastSlices(grid, record.scene, record.geometry.extent);
  record.plan = planStudy(settings, scene.occlusion.aperture, least);
  if (!earlier.empty()) record.earlier = readEarlierStudy(readTextFile(earlier), earlier.string(), record);
  const StudyFolder folder(root);
  folder.restore(record);
  if (!record.complete()) checkCases(context, grid, record);

  folder.create(record);
  StudyOutcome outcome;
  StudyRun run(context, grid, record, folder, progress);
  run.measure();
  outcome.nonFiniteVoxels = run.nonFiniteVoxels();
  outcome.complete = record.complete();
  outcome.casesDone = record.cases.size();
  outcome.cases = record.plan.cases.size();
  outcome.page = folder.page();
  outcome.table = folder.table();
  outcome.record = folder.record();
  writeTextFile(folder.table(), printTable(record));
  writePage(record, folder);
  return outcome;
}

}  // namespace umbrick
