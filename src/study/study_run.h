// Measures what a study asks for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "study/study_folder.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/render/techniques.h"
#include "umbrick/shade/slice_renderer.h"
#include "umbrick/study/study.h"

namespace umbrick {

/// Returns the depth between the nearest and the farthest visible brick in the picture of a scene, world units.
/// @throw InvalidArgument  nothing is visible
double visibleExtent(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene);

/// Returns the least number of slices: with fewer, bricks are too narrow for the slabs. @param extent  of visibleExtent
int leastSlices(const ScalarGrid& grid, const ResolvedScene& scene, double extent);

/// Checks that all cases can be drawn. @throw InvalidArgument  names the value of the plan that is the reason
void checkCases(const GlContext& context, const ScalarGrid& grid, const StudyRecord& record);

class StudyRun {
 public:
  /// @param record  what is measured already; grows, and is written to the folder after each step
  StudyRun(const GlContext& context, const ScalarGrid& grid, StudyRecord& record, const StudyFolder& folder,
           const StudyOptions& options);
  ~StudyRun();

  /// Measures what is missing, until the caller asks to stop.
  void measure();
  /// Returns the number for the volume; 0 when nothing was left to measure.
  std::uint64_t nonFiniteVoxels() const;

 private:
  struct Baseline;
  /// What draws a case, on OpenGL or on the CPU.
  struct CaseRenderer {
    std::shared_ptr<ResidentVolume> volume;  // none on the CPU
    std::unique_ptr<Renderer> renderer;
  };
  CaseRenderer rendererFor(const ResolvedScene& scene, bool onCpu, const RenderOptions& options);
  const Bricks& bricksFor(const ResolvedScene& scene);
  std::shared_ptr<ResidentVolume> residentFor(const ResolvedScene& scene);
  Baseline& baselineOf(int size);
  const Image& referenceImage(const StudyReference& what);
  bool report(const std::string& step, double share);
  bool integrate(const StudyReference& what, bool coarser, Image& image, double& milliseconds);
  bool measureReference(const StudyReference& what);
  void measureModelError(const StudyReference& cone);
  void measureCase(const StudyCase& what);
  /// Returns the statistics of a picture that counts its fragments and times its passes, which makes it slower.
  RenderStats countedPicture(const ResolvedScene& scene, bool onCpu);
  /// Hands a picture to the caller. @param truth  null: nothing is compared
  void show(const std::string& id, Model model, const Image& image, const Image* truth) const;
  void save() const;

  const GlContext& context_;
  const ScalarGrid& grid_;
  StudyRecord& record_;
  const StudyFolder& folder_;
  const StudyOptions& options_;
  // By interior, apron and whether there are several; those of techniques on the CPU have their own, by minus the
  // apron.
  std::map<std::tuple<int, int, bool>, std::unique_ptr<Bricks>> bricks_;
  ResidentVolumes resident_;                 // made of those bricks
  std::unique_ptr<Baseline> baseline_;       // baseline of the last size
  std::map<std::string, Image> references_;  // by id
  double work_ = 0, done_ = 0;               // estimated seconds of steps, for their ratio
};

}  // namespace umbrick
