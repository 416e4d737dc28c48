// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study.h"

#include <utility>

#include "core/text_file.h"
#include "study/study_run.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/study/case_scene.h"
#include "umbrick/study/study_table.h"

namespace umbrick {

StudyOutcome runStudy(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                      const StudySettings& settings, const std::filesystem::path& root, const StudyOptions& options) {
  // Everything that can be refused is refused before anything is written.
  const StudyPlan plan = planStudy(settings, scene.occlusion.aperture);
  validateScene(scene);
  const double voxelEdge = shortestVoxelEdge(grid.indexToWorld());
  StudyRecord record{.plan = plan, .scene = studyScene(scene, plan, voxelEdge)};
  record.geometry.voxelEdge = voxelEdge;
  record.volume = identifyVolume(scene.volume.file);
  record.scene.volume.file = record.volume.file;
  record.machine = describeMachine(context);
  record.machine.plotter = options.plotter;
  record.geometry.extent = visibleExtent(context, grid, record.scene);
  // The study is planned again, now that it is known how few slices can be drawn.
  const int least = leastSlices(grid, record.scene, record.geometry.extent);
  record.plan = planStudy(settings, scene.occlusion.aperture, least);
  if (!options.earlier.empty())
    record.earlier = readEarlierStudy(readTextFile(options.earlier), options.earlier.string(), record);
  const StudyFolder folder(root);
  folder.restore(record);
  if (!record.complete()) checkCases(context, grid, record);

  folder.create(record);
  StudyRun run(context, grid, record, folder, options);
  run.measure();
  writeTextFile(folder.table(), printTable(record));
  return {.study = std::move(record),
          .table = folder.table(),
          .record = folder.record(),
          .nonFiniteVoxels = run.nonFiniteVoxels()};
}

}  // namespace umbrick
