// SPDX-License-Identifier: Apache-2.0
#include "shade/light_windows.h"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <string>

#include "shade/constants.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// One call of a shader takes at most so many paths through a slice; this bounds its uniforms.
constexpr std::size_t kMostPaths = 64;
// Every driver takes so many groups of a compute shader along an axis.
constexpr int kMostGroupsAlong = 32768;

GLuint tilesAlong(int texels) { return static_cast<GLuint>((texels + kLatticeTile - 1) / kLatticeTile); }

std::uint64_t texelsOf(const glm::ivec2& size) {
  return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
}

// Returns the light windows of a run in the order of kViewLayer and kFirstLightLayer.
std::vector<LightWindow> byLayer(const LightRun& run) {
  std::vector<LightWindow> windows;
  run.forEachWindow([&](const LightWindow& window) { windows.push_back(window); });
  return windows;
}

// Returns where the first texel of the lattice lies in a light window whose paths have moved by `shift` texels.
glm::vec2 latticeInWindow(const LightLattice& lattice, const LightWindow& window, const glm::dvec2& shift) {
  return glm::vec2(glm::dvec2(lattice.first) - glm::dvec2(window.first) + shift);
}

}  // namespace

void LightWindows::checkCount(const GlFunctions& gl, const LightPaths& paths) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  const std::size_t mostLights = static_cast<std::size_t>(most) - kFirstLightLayer;
  if (paths.lights.size() > mostLights)
    throw InvalidArgument("directions: the light has " + std::to_string(paths.lights.size()) +
                          ", beyond the driver's limit of " + std::to_string(mostLights));
}

void LightWindows::begin(const Frame& frame, const LightPlan& plan) {
  const Sizes sizes{plan.geometry.lattice.size, plan.runs.windowSize,       static_cast<int>(plan.aimed.paths.count()),
                    plan.runs.slicesTogether,   frame.scene.occlusion.bits, plan.aimed.coloured};
  if (sizes != sizes_) makeTextures(frame.gl, sizes);
  if (!tiles_) tiles_ = GlBuffer(frame.gl);
  open_.assign(plan.aimed.paths.count(), {});
  const auto most = static_cast<int>(kMostPaths);
  const int fixedPoint = sizes.bits == 16;
  openProgram_.get(frame.gl, {{"kWindows", std::min(most, sizes.paths)}, {"kFixedPoint", fixedPoint}});
  stepProgram_.get(frame.gl, {{"kDirections", std::clamp(sizes.paths - 1, 1, most)},
                              {"kFixedPoint", fixedPoint},
                              {"kColoured", sizes.coloured}});
}

void LightWindows::makeTextures(const GlFunctions& gl, const Sizes& sizes) {
  sizes_ = {};  // no sizes count as made until all textures are
  const auto onLattice = [&](GLenum format) {
    return makeTextureArray(gl, format, sizes.lattice.x, sizes.lattice.y, sizes.slices, GL_LINEAR);
  };
  visibilityWeight_ = onLattice(GL_R32F);
  visibility_ = onLattice(sizes.visibilityFormat());
  windows_ = makeTextureArray(gl, sizes.windowFormat(), sizes.window.x, sizes.window.y, sizes.paths, GL_NEAREST);
  sizes_ = sizes;
}

std::uint64_t LightWindows::bytes() const {
  return texelsOf(sizes_.window) * static_cast<std::uint64_t>(sizes_.paths * sizes_.bits / 8) +
         texelsOf(sizes_.lattice) * static_cast<std::uint64_t>(sizes_.slices * bytesPerTexel(sizes_.coloured));
}

void LightWindows::carry(const GlFunctions& gl, const LightPlan& plan, const LightRun& run,
                         const GlTexture& extinction) {
  const std::span<const std::uint32_t> tiles = plan.tiles.of(run.slices.front(), run.slices.back());
  if (tiles.empty()) return;
  bindAll(gl, extinction, tiles);
  open(gl, run);
  // The first group also takes the view axis, so that there is one group even where there is no light.
  const std::size_t directions = plan.aimed.paths.lights.size();
  Group group = groupFrom(0, directions);
  while (true) {
    setGroup(plan, run, group);
    for (std::size_t m = 0; m < run.slices.size(); ++m) step(gl, plan, run, m, group);
    const std::size_t next = group.first + group.count;
    if (next == directions) break;
    group = groupFrom(next, directions);
  }
  gl.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

LightWindows::Group LightWindows::groupFrom(std::size_t first, std::size_t directions) {
  const std::size_t room = first == 0 ? kMostPaths - 1 : kMostPaths;  // the view axis is one of the first group
  return {first, std::min(room, directions - first)};
}

void LightWindows::bindAll(const GlFunctions& gl, const GlTexture& extinction,
                           std::span<const std::uint32_t> tiles) const {
  const auto bindImage = [&](int unit, const GlTexture& texture, GLenum format) {
    gl.BindImageTexture(static_cast<GLuint>(unit), texture.name(), 0, GL_TRUE, 0, GL_READ_WRITE, format);
  };
  gl.BindTextureUnit(kExtinctionUnit, extinction.name());
  bindImage(kWindowsImage, windows_, sizes_.windowFormat());
  bindImage(kVisibilityImage, visibility_, sizes_.visibilityFormat());
  bindImage(kVisibilityWeightImage, visibilityWeight_, GL_R32F);
  gl.NamedBufferData(tiles_.name(), static_cast<GLsizeiptr>(tiles.size_bytes()), tiles.data(), GL_STREAM_DRAW);
  gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kTilesBuffer, tiles_.name());
}

void LightWindows::bindVisibility(const GlFunctions& gl) const {
  gl.BindTextureUnit(kVisibilityUnit, visibility_.name());
  gl.BindTextureUnit(kVisibilityWeightUnit, visibilityWeight_.name());
}

// Returns which texels are in use, and where the first of them is in the texture, which holds the endless plane modulo
// its own size.
glm::vec4 LightWindows::place(const LightWindow& window) const {
  const glm::ivec2 texel(window.first % glm::vec<2, std::int64_t>(sizes_.window));
  return {glm::vec2(window.size), glm::vec2(texel + sizes_.window * glm::ivec2(glm::lessThan(texel, glm::ivec2(0))))};
}

// Opens the windows of a run: light is 1 on paths that the windows of the run before did not hold.
void LightWindows::open(const GlFunctions& gl, const LightRun& run) {
  const std::vector<LightWindow> windows = byLayer(run);
  GlProgram& program = openProgram_.current();
  program.set("window_size", glm::vec2(sizes_.window));
  program.use();
  for (std::size_t first = 0; first < windows.size(); first += kMostPaths) {
    std::vector<glm::vec4> now, before;
    glm::ivec2 largest(0);
    for (std::size_t layer = first; layer < std::min(first + kMostPaths, windows.size()); ++layer) {
      const glm::vec<2, std::int64_t> from = open_[layer].first - windows[layer].first;
      now.push_back(place(windows[layer]));
      before.emplace_back(glm::vec2(from), glm::vec2(from + glm::vec<2, std::int64_t>(open_[layer].size)));
      largest = glm::max(largest, windows[layer].size);
    }
    if (largest.x == 0 || largest.y == 0) continue;
    program.set("window", now);
    program.set("window_before", before);
    program.set("first_layer", static_cast<int>(first));
    gl.DispatchCompute(tilesAlong(largest.x), tilesAlong(largest.y), static_cast<GLuint>(now.size()));
  }
  gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  open_ = windows;
}

// Sets the uniforms that are the same on all slices of the run.
void LightWindows::setGroup(const LightPlan& plan, const LightRun& run, const Group& group) {
  GlProgram& program = stepProgram_.current();
  std::vector<glm::vec4> windows;
  for (std::size_t k = group.first; k < group.first + group.count; ++k) windows.push_back(place(run.lights[k]));
  program.set("window_size", glm::vec2(sizes_.window));
  program.set("view_window", place(run.view));
  program.set("window", windows);
  program.set("radiance", std::span(plan.aimed.radiance).subspan(group.first, group.count));
  program.set("first_layer", kFirstLightLayer + static_cast<int>(group.first));
  program.set("direction_count", static_cast<int>(group.count));
  program.set("add", group.first > 0 ? 1 : 0);
}

// Takes the light of a group through slice m of the run.
void LightWindows::step(const GlFunctions& gl, const LightPlan& plan, const LightRun& run, std::size_t m,
                        const Group& group) {
  const std::int64_t slice = run.slices[m];
  const auto tiles = static_cast<int>(plan.tiles.of(slice, slice).size());
  if (tiles == 0) return;
  const LightGeometry& geometry = plan.geometry;
  const double depth = geometry.extents.depths[static_cast<std::size_t>(slice)] / geometry.lattice.texel;
  std::vector<glm::vec4> paths;
  for (std::size_t k = group.first; k < group.first + group.count; ++k) {
    const LightSlope& light = plan.aimed.paths.lights[k];
    const glm::dvec2 shift = wholeShift(depth, light, plan.roundings[k]);
    paths.emplace_back(latticeInWindow(geometry.lattice, run.lights[k], shift), light.stretch, 1 / (1 + light.stretch));
  }
  GlProgram& program = stepProgram_.current();
  program.set("view_path", latticeInWindow(geometry.lattice, run.view, glm::dvec2(0)));
  program.set("path", paths);
  program.set("first_tile", static_cast<int>(plan.tiles.of(run.slices.front(), slice).size()) - tiles);
  program.set("tile_count", tiles);
  program.set("layer", static_cast<int>(m));
  program.use();
  const int columns = std::min(tiles, kMostGroupsAlong);
  gl.DispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>((tiles + columns - 1) / columns), 1);
  gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace umbrick
