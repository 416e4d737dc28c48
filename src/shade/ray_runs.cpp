// SPDX-License-Identifier: Apache-2.0
#include "shade/ray_runs.h"

#include <algorithm>
#include <string>

#include "shade/brick_runs.h"
#include "shade/constants.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick {

RayFrame RayRuns::frameOf(const RayRunPlan& plan, const CellBox& cells) const {
  return {plan.view, cells, resident_.volume().layout.interior, plan.spacing, plan.segments, plan.phase, plan.corner};
}

void RayRuns::draw(const RayRunPlan& plan, const std::function<void(const RayFrame&, const RayRun&)>& draw,
                   RenderStats& stats) {
  if (plan.bricks.size() == 0) return;
  Walk walk{plan, draw, stats, glm::ivec3(1), std::nullopt, 0};
  const glm::ivec3 interior = resident_.volume().layout.interior;
  // As long as single precision is fine enough for all of the volume, all runs share their coordinates, so that what
  // lies at a face between two is in exactly one of them.
  constexpr std::int64_t kMostVoxels = 1 << 16;
  const CellBox all = cellsAround(plan.bricks.origins(), interior);
  const glm::i64vec3 extent = all.count * glm::i64vec3(interior);
  if (std::max({extent.x, extent.y, extent.z}) <= kMostVoxels) walk.shared = frameOf(plan, all);
  // Cells are parts of bricks as long as one table holds all of them.
  if (plan.skips && SlotTable::fits(cellsAround(plan.bricks.origins(), interior, parts_.count())))
    walk.parts = parts_.count();
  BrickRuns(plan.view, plan.bricks.origins()).draw([&](std::span<const std::int32_t> positions) {
    if (drawRun(walk, positions)) return true;
    if (!plan.together.empty())
      throw InvalidArgument("bricks.budgetMiB: " + std::string(plan.together) +
                            " need all visible bricks at once, which are more than fit the memory budget or OpenGL");
    return false;
  });
}

// Draws bricks in one go, or returns false where they are too many.
bool RayRuns::drawRun(Walk& walk, std::span<const std::int32_t> positions) {
  const RayRunPlan& plan = walk.plan;
  const glm::ivec3 interior = resident_.volume().layout.interior;
  std::vector<glm::ivec3> origins;
  for (const std::int32_t position : positions)
    origins.push_back(plan.bricks.origins()[static_cast<std::size_t>(position)]);
  RayRun run;
  run.cells.positions = positions;
  run.cells.cells = cellsAround(origins, interior, walk.parts);
  run.cells.parts = walk.parts;
  run.cells.version = plan.version;
  run.cells.joins = plan.joins;
  if (!SlotTable::fits(run.cells.cells)) return false;
  if (!plan.fits && positions.size() > std::max<std::size_t>(1, resident_.atlas().slots())) return false;
  const Stopwatch upload;
  plan.bricks.require(positions);
  if (plan.require) plan.require(positions);
  run.cells.textures = SlotTable::texturesOf(plan.bricks, positions);
  if (run.cells.textures.size() > static_cast<std::size_t>(kRayTextures)) return false;
  if (shown_.empty() || !(key_ == std::pair(plan.version, origins))) {
    shown_.clear();
    findParts(walk, positions, origins);
    key_ = {plan.version, origins};
  }
  run.cells.shown = shown_;
  run.cells.bounds = bounds_;
  walk.stats.uploadMs += upload.elapsedMs();
  run.done = walk.done;
  run.share = static_cast<double>(positions.size()) / static_cast<double>(plan.bricks.size());
  walk.done += run.share;
  const RayFrame frame = walk.shared ? *walk.shared : frameOf(plan, cellsAround(origins, interior));
  if (frame.count > 0) walk.draw(frame, run);
  return true;
}

void RayRuns::findParts(const Walk& walk, std::span<const std::int32_t> positions,
                        std::span<const glm::ivec3> origins) {
  const RayRunPlan& plan = walk.plan;
  const bool divided = walk.parts != glm::ivec3(1);
  const std::size_t each = divided ? parts_.perBrick() : 1;
  std::vector<std::uint8_t> shown(origins.size() * each, 1);
  bounds_.assign(plan.bound ? shown.size() : 0, 0.0f);
  if (divided) parts_.read(origins);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (divided)
      parts_.each(origins[i], [&](std::size_t part, const Range& value, const Range& gradient, const Range& emission) {
        shown[i * each + part] = plan.isShown(value, gradient, emission);
        if (plan.bound) bounds_[i * each + part] = plan.bound(value);
      });
    else if (plan.bound)
      bounds_[i] = plan.bound(plan.bricks.brick(positions[i]).value);
  }
  shown_ = std::move(shown);
}

void bindVoxels(const GlFunctions& gl, const BrickAtlas& atlas, std::span<const int> textures) {
  for (std::size_t i = 0; i < textures.size(); ++i)
    gl.BindTextureUnit(i == 0 ? kAtlasUnit : kMoreAtlasUnit + static_cast<GLuint>(i) - 1, atlas.texture(textures[i]));
}

void drawPixels(const GlFunctions& gl, const PixelBox& box, const RayRun& run,
                const std::function<void(double)>& progress) {
  constexpr double kLongMs = 100;
  int rows = progress ? 64 : box.max.y - box.min.y;
  gl.Enable(GL_SCISSOR_TEST);
  for (int y = box.min.y; y < box.max.y;) {
    const int end = std::min(y + rows, box.max.y);
    gl.Scissor(box.min.x, y, box.max.x - box.min.x, end - y);
    const Stopwatch watch;
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    y = end;
    if (!progress) continue;
    gl.Finish();
    if (watch.elapsedMs() < kLongMs) rows *= 2;  // what is fast is cut into few
    progress(run.done + run.share * (y - box.min.y) / (box.max.y - box.min.y));
  }
  gl.Disable(GL_SCISSOR_TEST);
}

}  // namespace umbrick
