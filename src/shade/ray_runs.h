// Which bricks rays are taken through at once, and what is known of their cells.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "shade/brick_parts.h"
#include "shade/ray_frame.h"
#include "shade/slot_table.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Bricks that are drawn at once; they are resident.
struct RayRun {
  SlotCells cells;             // in at most kRayTextures textures
  double done = 0, share = 1;  // shares of the picture: what was drawn before, and what this is
};

/// What the runs of a picture depend on.
struct RayRunPlan {
  const IndexView& view;
  BrickSelection& bricks;
  bool fits = true;  // all of them are resident at once
  double spacing = 1;
  int segments = 1;  // see RayFrame
  double phase = 0.5, corner = kAroundVoxels;
  bool skips = true;               // cells are parts of bricks, so that rays skip what is empty in a brick
  bool joins = true;               // see SlotCells
  std::string_view together = {};  // what needs all bricks in one run; empty: nothing
  /// What the parts of bricks show. A number stands for it, which changes with it.
  std::uint64_t version = 0;
  std::function<bool(const Range& value, const Range& gradient, const Range& emission)> isShown = {};
  std::function<float(const Range& value)> bound = {};  // see SlotCells::bounds; none: there is none
  /// Brings what lies beside these bricks, such as light.
  std::function<void(std::span<const std::int32_t> positions)> require = {};
};

/// Draws the bricks of pictures in as few runs as the atlas, the table of slots and the shader can do with, nearest
/// first.
class RayRuns {
 public:
  /// @param resident  outlives this
  explicit RayRuns(ResidentVolume& resident) : resident_(resident), parts_(resident.volume()) {}
  /// @param draw   a run, whose places are counted as the frame says
  /// @param stats  gets the times
  /// @throw InvalidArgument  bricks do not fit into one run that the plan wants together
  void draw(const RayRunPlan& plan, const std::function<void(const RayFrame&, const RayRun&)>& draw,
            RenderStats& stats);

 private:
  // What all runs of a picture share.
  struct Walk {
    const RayRunPlan& plan;
    const std::function<void(const RayFrame&, const RayRun&)>& draw;
    RenderStats& stats;
    glm::ivec3 parts{1};             // of a brick
    std::optional<RayFrame> shared;  // coordinates of all runs; none: each has its own
    double done = 0;                 // share of the bricks that is drawn
  };
  RayFrame frameOf(const RayRunPlan& plan, const CellBox& cells) const;
  bool drawRun(Walk& walk, std::span<const std::int32_t> positions);
  void findParts(const Walk& walk, std::span<const std::int32_t> positions, std::span<const glm::ivec3> origins);

  ResidentVolume& resident_;
  BrickParts parts_;
  // Of the last run:
  std::vector<std::uint8_t> shown_;
  std::vector<float> bounds_;
  std::pair<std::uint64_t, std::vector<glm::ivec3>> key_;
};

/// Binds textures of the atlas where shaders look for them.
void bindVoxels(const GlFunctions& gl, const BrickAtlas& atlas, std::span<const int> textures);

/// Draws a triangle over pixels, in bands of rows where somebody wants to hear how far a picture is.
/// @pre program, targets and vertex array are bound
void drawPixels(const GlFunctions& gl, const PixelBox& box, const RayRun& run,
                const std::function<void(double)>& progress);

}  // namespace umbrick
