// What of the light's windows a sweep needs, worked out before anything is drawn.
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

/// The window of the paths of one direction while they pass a run of slices: texels [first, first + size) of an endless
/// plane of their own, on which a path keeps its place from slice to slice.
struct LightWindow {
  glm::vec<2, std::int64_t> first{0};  // grows with the depth times the slope
  glm::ivec2 size{0};
  double area() const { return static_cast<double>(size.x) * size.y; }
};

/// Slices that are lit together, with what each path needs for them.
struct LightRun {
  std::vector<std::int64_t> slices;  // those with bricks, ascending
  LightWindow view;                  // of the view axis
  std::vector<LightWindow> lights;   // by direction of the light
  /// Visits the view's window and then those of the lights.
  template <class Visit>
  void forEachWindow(const Visit& visit) const {
    visit(view);
    for (const LightWindow& window : lights) visit(window);
  }
};

/// Cuts slices [first, last) into runs of at most `longest` slices, fewer where the windows would get larger than
/// `most` texels each. A window holds the paths that something has touched until the end of the run and that something
/// seen in it or later reads: others are 1 or not asked for. @pre extents hold all slices of the picture
class LightPlanner {
 public:
  LightPlanner(const LightExtents& extents, const LightPaths& paths);
  std::vector<LightRun> runs(std::int64_t first, std::int64_t last, int longest, double most) const;

 private:
  // The paths of one direction, as rectangles of their plane.
  struct PathPlan {
    PathPlan(const LightExtents& extents, const LightSlope& light);
    LightWindow window(std::int64_t first, std::int64_t last) const;
    std::vector<Rectangle> readFrom;      // by slice: read on it or on a later one
    std::vector<Rectangle> touchedUntil;  // by slice: touched on it or on an earlier one
  };
  LightRun windowsOf(std::int64_t first, std::int64_t last) const;  // a run without its slices
  const LightExtents& extents_;
  PathPlan view_;
  std::vector<PathPlan> lights_;
};

/// All runs of a picture, and the sizes of the textures that take any of them.
struct LightRuns {
  std::vector<LightRun> runs;  // in order of slices
  glm::ivec2 windowSize{1};    // texels that hold the window of any path
  int slicesTogether = 1;      // slices of the longest run, at most
  /// The runs of slices [first, last), which no run reaches across.
  std::span<const LightRun> within(std::int64_t first, std::int64_t last) const;
};

/// @param sweeps         slices that are drawn together; a run lies within one of them
/// @param bytesPerSlice  what one slice of a run takes on the lattice
LightRuns planLightRuns(const LightPlanner& planner, std::span<const SweepRun> sweeps, double bytesPerSlice);

/// All that is known of the light of a picture before anything is drawn.
struct LightPlan {
  AimedLight aimed;
  std::vector<glm::dvec2> roundings;  // by direction, see shiftRoundings
  LightGeometry geometry;
  LatticeTiles tiles;
  LightRuns runs;
};

}  // namespace umbrick
