// Works out what a sweep needs of the light's windows, before anything is drawn.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "shade/lattice_tiles.h"
#include "shade/light_aim.h"
#include "shade/light_geometry.h"
#include "shade/sweep_plan.h"

namespace umbrick {

/// The light window of one direction is the part of its paths that a run of slices needs: texels [first, first + size)
/// of an endless plane of their own, on which a path keeps its place from slice to slice.
struct LightWindow {
  glm::vec<2, std::int64_t> first{0};  // grows with the depth times the slope
  glm::ivec2 size{0};
  double area() const { return static_cast<double>(size.x) * size.y; }
};

/// Slices that are lit together, with what each path needs for them.
struct LightRun {
  std::vector<std::int64_t> slices;  // the slices of the run that have bricks, ascending
  LightWindow view;                  // light window of the view axis
  std::vector<LightWindow> lights;   // light window of each direction of the light
  /// Visits the view's window and then those of the lights.
  template <class Visit>
  void forEachWindow(const Visit& visit) const {
    visit(view);
    for (const LightWindow& window : lights) visit(window);
  }
};

/// Cuts slices [first, last) into runs of at most `longest` slices, fewer where the light windows would get larger than
/// `most` texels each. A window holds the paths that something has touched until the end of the run and that something
/// seen in the run or later reads: on all other paths light is 1 or not asked for.
/// @pre extents hold all slices of the picture
class LightPlanner {
 public:
  LightPlanner(const LightExtents& extents, const LightPaths& paths);
  std::vector<LightRun> runs(std::int64_t first, std::int64_t last, int longest, double most) const;

 private:
  // The paths of one direction, as rectangles of their plane.
  struct PathPlan {
    PathPlan(const LightExtents& extents, const LightSlope& light);
    LightWindow window(std::int64_t first, std::int64_t last) const;
    std::vector<Rectangle> readFrom;      // for each slice: the paths that are read on it or on a later one
    std::vector<Rectangle> touchedUntil;  // for each slice: the paths that are touched on it or on an earlier one
  };
  LightRun windowsOf(std::int64_t first, std::int64_t last) const;  // returns a run without its slices
  const LightExtents& extents_;
  PathPlan view_;
  std::vector<PathPlan> lights_;
};

/// All runs of a picture, and the sizes of textures that are large enough for any of them.
struct LightRuns {
  std::vector<LightRun> runs;  // in order of their slices
  glm::ivec2 windowSize{1};    // texels of a texture that holds the light window of any path
  int slicesTogether = 1;      // most slices of a run
  /// Returns the runs of slices [first, last). @pre no run reaches across either end
  std::span<const LightRun> within(std::int64_t first, std::int64_t last) const;
};

/// Plans the runs of a picture.
/// @param sweeps  slices that are drawn together; a run lies within one of them
/// @param bytesPerSlice  memory that one slice of a run takes on the lattice
LightRuns planLightRuns(const LightPlanner& planner, std::span<const SweepRun> sweeps, double bytesPerSlice);

/// All that is known about the light of a picture before anything is drawn.
struct LightPlan {
  AimedLight aimed;
  std::vector<glm::dvec2> roundings;  // for each direction, see shiftRoundings
  LightGeometry geometry;
  LatticeTiles tiles;
  LightRuns runs;
};

}  // namespace umbrick
