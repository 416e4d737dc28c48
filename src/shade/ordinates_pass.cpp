// Discrete ordinates: one transmittance per direction of the light, carried along its paths. On a slice at depth s the
// path of direction k through X is texel U = X + s slope_k of a window, the same on every slice: slices only multiply
// what is there, so nothing is resampled on the way, empty space costs nothing, and what is off the screen occludes.
// Shifts are rounded to whole texels, each slice by itself: a path then meets lattice texels and not mixtures of them,
// off by less than a texel and by nothing on average. Interpolation would blur occluders more than that, and costs
// more.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <optional>
#include <string>

#include "shade/eye_sweep.h"
#include "shade/light_plan.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"
#include "umbrick/scene/lights.h"

namespace umbrick {
namespace {

constexpr int kMostSlices = 32;      // that are lit together
constexpr int kMostDirections = 64;  // that one shader takes through a slice
constexpr int kTile = 8;             // texels along the edge of a compute shader's tile
constexpr double kSliceBytes = 64 << 20;
constexpr double kMostTexelsAlong = 2048;  // of the diagonal of a volume, where nobody asks for more
// Rounds shifts to whole texels. Light at 45 degrees has halves on every slice, and slopes are known to 1e-16: halves
// have to go one way, or slices jump as the camera moves.
constexpr double kRound = 0.5 - 1e-6;

class OrdinatesPass : public SlicePass {
 public:
  void plan(Frame& frame) override {
    aim(frame);
    chooseRoundings(frame.sample.rounding);
    chooseLattice(frame);
    cutLightSlices(frame);
    planner_.emplace(extents_, slopes_);
  }
  const ProxySlices* occluders() const override { return &lightSlices_; }

  void begin(Frame& frame, std::span<const SweepRun> runs) override {
    planRuns(runs);
    markTiles(frame);
    makeTextures(frame);
    compile(frame);
    sweep_.begin(frame);
    open_.assign(slopes_.size(), {});
  }

  void fill(Frame& frame, std::int64_t first, std::int64_t last) override {
    std::vector<int> eye(static_cast<std::size_t>(last - first), -1), light(eye);
    for (const LightRun& run : runsOf(first, last))
      for (std::size_t m = 0; m < run.slices.size(); ++m) {
        const auto at = static_cast<std::size_t>(run.slices[m] - first);
        eye[at] = static_cast<int>(m);
        if (occludes(run.slices[m])) light[at] = static_cast<int>(m);
      }
    frame.polygons.fill(frame.slices, first, last, frame.view, frame.atlas, frame.reverseBricks, eye);
    lightPolygons_->fill(lightSlices_, first, last, lightView_, frame.atlas, frame.reverseBricks, light);
  }

  void draw(Frame& frame, std::int64_t first, std::int64_t last) override {
    for (const LightRun& run : runsOf(first, last)) {
      light(frame, run);
      const std::span<const SliceDraw> draws = drawsOf(frame.polygons.draws(), run);
      if (!draws.empty()) {
        frame.gl.BindTextureUnit(8, visibility_.name());
        frame.gl.BindTextureUnit(9, weights_.name());
        sweep_.draw(frame, draws, eye_.current());
        frame.clock.lap(&PassTimes::eyeMs);
      }
    }
  }

  double brightest() const override { return brightest_; }

  void addTo(RenderStats& stats) const override {
    const auto texels = [](const glm::ivec2& size) {
      return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    };
    stats.directions = static_cast<int>(slopes_.size()) - 1;
    stats.windowTexel = lattice_.texel;
    stats.windowBytes = texels(windowSize_) * slopes_.size() * static_cast<std::uint64_t>(windowBits_) / 8 +
                        texels(lattice_.size) * static_cast<std::uint64_t>(slicesTogether_ * latticeBytes());
    stats.bufferBytes += stats.windowBytes;
    stats.windowUpdates = static_cast<std::uint64_t>(firstTile_.back()) * kTile * kTile * slopes_.size();
  }

 private:
  // Directions as the slices see them, and the light they bring.
  void aim(const Frame& frame) {
    // An environment map takes long to walk.
    if (!slopes_.empty() && frame.sample.lights.empty() && aimedFrom_ == frame.camera) return;
    Scene scene = frame.scene;
    scene.camera = frame.camera;
    const CameraFrame axes = cameraFrame(frame.camera);
    const std::vector<LightDirection> lights =
        frame.sample.lights.empty() ? lightDirections(scene, scene.occlusion.directions) : frame.sample.lights;
    light_ = glm::dvec3(0);
    for (const LightDirection& light : lights) light_ += light.radiance;
    brightest_ = frame.scene.sampling.bits == 16 ? std::max({1.0, light_.r, light_.g, light_.b}) : 1;
    const double power = light_.r + light_.g + light_.b;
    coloured_ = false;
    slopes_.clear();
    radiance_.clear();
    // The view axis comes first: it brings no light, but tells where the eye sees anything.
    slopes_.push_back({glm::dvec2(0), 1});
    radiance_.emplace_back(0.0f);
    for (const auto& [direction, radiance] : lights) {
      slopes_.push_back(lightSlope(
          {glm::dot(direction, axes.right), glm::dot(direction, axes.up), -glm::dot(direction, axes.forward)}));
      const double share = power > 0 ? (radiance.r + radiance.g + radiance.b) / power : 0;
      radiance_.emplace_back(radiance, share);
      // Light of one colour is a number per direction.
      const glm::dvec3 tint = glm::abs(radiance - share * light_);
      coloured_ = coloured_ || std::max({tint.r, tint.g, tint.b}) > 1e-9 * power;
    }
    group_ = std::min<std::size_t>(kMostDirections, slopes_.size());
    aimedFrom_.reset();
    if (frame.sample.lights.empty()) aimedFrom_ = frame.camera;
  }

  // What is added to the shift of a direction before it is cut to whole texels: one half for all, or for each its own,
  // spread evenly (Roberts 2018, the sequence R2).
  void chooseRoundings(const glm::dvec2& rounding) {
    roundings_.assign(slopes_.size(), glm::dvec2(kRound));
    if (rounding == glm::dvec2(0.5)) return;
    for (std::size_t k = 0; k < roundings_.size(); ++k)
      roundings_[k] = glm::fract(rounding + static_cast<double>(k) * kR2Step);
  }

  void chooseLattice(const Frame& frame) {
    const ProxySlices& slices = frame.slices;
    const double scale = frame.scene.occlusion.scale;
    // Paths are off by up to a texel across and half a slab along: neither alone is worth refining, and slabs thinner
    // than texels let more light through what is thinner than a texel. Detail below a voxel is not worth it either;
    // that of a pixel does not matter, since occluders smaller than that cast shadows, too.
    // Of huge volumes texels are larger, so that windows keep to some 16 MiB a direction.
    lattice_.texel = scale > 0 ? frame.voxelEdge / scale
                               : std::max({slices.spacing, frame.voxelEdge, frame.diagonal / kMostTexelsAlong});
    extents_ = {};
    extents_.texel = lattice_.texel;
    for (std::int64_t i = 0; i < slices.count(); ++i) extents_.depths.push_back(slices.depth(i));
    lattice_.shift = frame.sample.latticeShift;
    extents_.seen = polygonExtents(slices, frame.view, -lattice_.offset(), lattice_.texel);
    needed_ = neededRegions(extents_, slopes_);
    Rectangle all;
    const Rectangle bricks = bricksAcross(frame);
    for (const Rectangle& needed : needed_) all.include(needed.within(bricks));
    if (all.empty()) {
      lattice_.first = glm::ivec2(0);
      lattice_.size = glm::ivec2(1);
      return;
    }
    const glm::dvec2 low = glm::floor(all.min) - 2.0, high = glm::ceil(all.max) + 2.0;
    checkSize(frame, high - low);
    lattice_.first = glm::ivec2(low);
    lattice_.size = glm::ivec2(high - low);
  }

  void checkSize(const Frame& frame, const glm::dvec2& texels) const {
    GLint edge = 0, layers = 0;
    frame.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &edge);
    frame.gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    const auto most = static_cast<std::size_t>(layers);
    if (slopes_.size() > most)
      throw InvalidArgument("directions: the light has " + std::to_string(slopes_.size()) +
                            ", beyond the driver's limit of " + std::to_string(most));
    // Of the windows, too, which are as large.
    if (!(std::max(texels.x, texels.y) <= edge))
      throw InvalidArgument("occlusion.scale: window texels of " + std::to_string(lattice_.texel) +
                            " are too small, light needs more of them side by side than the driver's limit of " +
                            std::to_string(edge));
  }

  // All visible bricks, on whatever slice.
  Rectangle bricksAcross(const Frame& frame) const {
    Rectangle across;
    const glm::dvec3 edge(frame.atlas.layout().interior);
    for (const Brick& brick : frame.atlas.bricks()) {
      const glm::dvec3 low = glm::dvec3(brick.origin) - 0.5;
      for (unsigned c = 0; c < 8; ++c) {
        const glm::dvec3 corner = low + edge * glm::dvec3(c & 1, c >> 1 & 1, c >> 2 & 1);
        const glm::dvec2 point = glm::dvec2(frame.view.toView(corner)) / lattice_.texel - lattice_.shift;
        across.min = glm::min(across.min, point);
        across.max = glm::max(across.max, point);
      }
    }
    return across;
  }

  // The same slices, in parallel projection onto the lattice.
  void cutLightSlices(const Frame& frame) {
    const glm::dvec2 centre = lattice_.centre();
    lightView_ = frame.view;
    lightView_.projection = Projection::orthographic;
    lightView_.halfExtent = 0.5 * lattice_.texel * glm::dvec2(lattice_.size);
    lightView_.size = lattice_.size;
    lightView_.origin -= glm::dvec3(centre, 0);
    lightView_.eyeIndex += centre.x * frame.view.toIndex[0] + centre.y * frame.view.toIndex[1];
    const auto seenFrom = [&](std::vector<glm::dvec4> planes) {
      for (glm::dvec4& plane : planes) plane.w += plane.x * centre.x + plane.y * centre.y;
      return planes;
    };
    lightPlanes_ = seenFrom(frame.planes);
    std::vector<glm::ivec3> origins;
    for (const Brick& brick : frame.atlas.bricks()) origins.push_back(brick.origin);
    lightSlices_ = cutSlices(lightView_, origins, frame.atlas.layout().interior, seenFrom(frame.bounds),
                             frame.slices.spacing, frame.slices.phase);
    extents_.occluding = polygonExtents(lightSlices_, lightView_, centre - lattice_.offset(), lattice_.texel);
    for (std::size_t i = 0; i < needed_.size(); ++i)
      extents_.occluding[i] = extents_.occluding[i].within(needed_[i].grown(2));
  }

  bool occludes(std::int64_t slice) const { return !extents_.occluding[static_cast<std::size_t>(slice)].empty(); }
  bool isSeen(std::int64_t slice) const { return !extents_.seen[static_cast<std::size_t>(slice)].empty(); }

  void planRuns(std::span<const SweepRun> sweeps) {
    runs_.clear();
    windowSize_ = glm::ivec2(1);
    // Long runs save the driver work; their windows may be half as large again as those of single slices.
    double area = 1;
    for (const SweepRun& sweep : sweeps)
      for (const LightRun& run : planner_->runs(sweep.first, sweep.last, 1, 0))
        for (const LightWindow& window : run.windows)
          area = std::max(area, static_cast<double>(window.size.x) * window.size.y);
    const double perSlice = static_cast<double>(latticeBytes()) * lattice_.size.x * lattice_.size.y;
    slicesTogether_ = static_cast<int>(std::clamp(kSliceBytes / perSlice, 1.0, static_cast<double>(kMostSlices)));
    for (const SweepRun& sweep : sweeps)
      for (LightRun& run : planner_->runs(sweep.first, sweep.last, slicesTogether_, 1.5 * area)) {
        for (const LightWindow& window : run.windows) windowSize_ = glm::max(windowSize_, window.size);
        runs_.push_back(std::move(run));
      }
  }

  // Tiles of the lattice, by slice, where something is seen or occludes.
  void markTiles(const Frame& frame) {
    const std::size_t count = extents_.depths.size();
    const glm::ivec2 grid = (lattice_.size + kTile - 1) / kTile;
    std::vector<std::vector<GLuint>> tiles(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
      std::vector<bool> marked;
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        if (extents_.seen[i].empty() && extents_.occluding[i].empty()) continue;
        marked.assign(static_cast<std::size_t>(grid.x) * static_cast<std::size_t>(grid.y), false);
        const auto mark = [&](const Rectangle& texels) {
          if (texels.empty()) return;
          const glm::dvec2 origin(lattice_.first);
          const glm::ivec2 low = glm::max(glm::ivec2(glm::floor((texels.min - origin) / double(kTile))), glm::ivec2(0));
          const glm::ivec2 high = glm::min(glm::ivec2(glm::floor((texels.max - origin) / double(kTile))), grid - 1);
          for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
              marked[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.x) + static_cast<std::size_t>(x)] =
                  true;
        };
        const auto slice = static_cast<std::int64_t>(i);
        // What is seen is interpolated between texels.
        forEachPolygon(frame.slices, slice, frame.view, -lattice_.offset(), lattice_.texel,
                       [&](const Rectangle& texels) { mark(texels.grown(1)); });
        forEachPolygon(lightSlices_, slice, lightView_, lattice_.centre() - lattice_.offset(), lattice_.texel,
                       [&](const Rectangle& texels) { mark(texels.within(extents_.occluding[i])); });
        for (std::size_t t = 0; t < marked.size(); ++t)
          if (marked[t])
            tiles[i].push_back(static_cast<GLuint>(t % static_cast<std::size_t>(grid.x)) |
                               static_cast<GLuint>(t / static_cast<std::size_t>(grid.x)) << 16);
      }
    });
    firstTile_.assign(1, 0);
    tileList_.clear();
    for (const std::vector<GLuint>& slice : tiles) {
      tileList_.insert(tileList_.end(), slice.begin(), slice.end());
      firstTile_.push_back(tileList_.size());
    }
    if (!tiles_) tiles_ = GlBuffer(frame.gl);
  }

  // The part of a list in order of slices that lies in [first, last).
  template <class List, class SliceOf>
  static auto within(const List& list, std::int64_t first, std::int64_t last, const SliceOf& sliceOf) {
    const auto begin = std::ranges::lower_bound(list, first, {}, sliceOf);
    return std::span(begin, std::ranges::lower_bound(begin, list.end(), last, {}, sliceOf));
  }
  std::span<const LightRun> runsOf(std::int64_t first, std::int64_t last) const {
    return within(runs_, first, last, [](const LightRun& run) { return run.slices.front(); });
  }
  static std::span<const SliceDraw> drawsOf(const std::vector<SliceDraw>& draws, const LightRun& run) {
    return within(draws, run.slices.front(), run.slices.back() + 1, &SliceDraw::slice);
  }

  void makeTextures(const Frame& frame) {
    const GlFunctions& gl = frame.gl;
    if (!lightPolygons_) lightPolygons_.emplace(gl);
    const Sizes sizes{lattice_.size, windowSize_, static_cast<int>(slopes_.size()), slicesTogether_, coloured_};
    if (sizes_ == sizes) return;
    sizes_ = {};  // until all are made
    windowBits_ = frame.scene.occlusion.bits;
    const auto array = [&](GLenum kind, const glm::ivec2& size, int layers, GLenum filter) {
      return makeTextureArray(gl, kind, size.x, size.y, layers, filter);
    };
    extinction_ = array(GL_R32F, lattice_.size, slicesTogether_, GL_NEAREST);
    extinctionTarget_ = makeFramebuffer(gl, {extinction_.name()});
    weights_ = array(GL_R32F, lattice_.size, slicesTogether_, GL_LINEAR);
    visibility_ = array(visibilityFormat(), lattice_.size, slicesTogether_, GL_LINEAR);
    windows_ = array(windowFormat(frame), windowSize_, static_cast<int>(slopes_.size()), GL_NEAREST);
    sizes_ = sizes;
  }

  // Of a texel of one slice: extinction, weight and visibility.
  int latticeBytes() const { return coloured_ ? 24 : 16; }
  GLenum visibilityFormat() const { return coloured_ ? GL_RGBA32F : GL_RG32F; }
  static GLenum windowFormat(const Frame& frame) { return frame.scene.occlusion.bits == 16 ? GL_R16 : GL_R32F; }

  void compile(const Frame& frame) {
    const GlFunctions& gl = frame.gl;
    const ShaderConstants windows{{"kDirections", static_cast<int>(group_)},
                                  {"kFixedPoint", frame.scene.occlusion.bits == 16},
                                  {"kColoured", coloured_}};
    openWindows_.get(gl, windows);
    step_.get(gl, windows);
    ShaderConstants light = slabConstants(frame);
    light["kPerspective"] = 0;
    setSlabUniforms(absorb_.get(gl, light), frame, lightView_, lightPlanes_);
    ShaderConstants eye = slabConstants(frame);
    eye["kColoured"] = coloured_;
    GlProgram& program = eye_.get(gl, eye);
    setSlabUniforms(program, frame);
    const glm::dvec2 texels(lattice_.size);
    program.set("lattice_map",
                glm::vec4(1.0 / (lattice_.texel * texels), -(glm::dvec2(lattice_.first) + lattice_.shift) / texels));
    program.set("whole_light", glm::vec3(light_));
    program.set("brightest", static_cast<float>(brightest_));
  }

  // Brings light to the slices of a run.
  void light(Frame& frame, const LightRun& run) {
    const GlFunctions& gl = frame.gl;
    drawExtinction(frame, run);
    frame.clock.lap(&PassTimes::extinctionMs);
    gl.BindTextureUnit(5, extinction_.name());
    gl.BindImageTexture(0, windows_.name(), 0, GL_TRUE, 0, GL_READ_WRITE, windowFormat(frame));
    gl.BindImageTexture(2, weights_.name(), 0, GL_TRUE, 0, GL_READ_WRITE, GL_R32F);
    gl.BindImageTexture(1, visibility_.name(), 0, GL_TRUE, 0, GL_READ_WRITE, visibilityFormat());
    const auto tiles = std::span(tileList_).subspan(firstTile_[static_cast<std::size_t>(run.slices.front())],
                                                    firstTile_[static_cast<std::size_t>(run.slices.back()) + 1] -
                                                        firstTile_[static_cast<std::size_t>(run.slices.front())]);
    if (tiles.empty()) return;
    gl.NamedBufferData(tiles_.name(), static_cast<GLsizeiptr>(tiles.size_bytes()), tiles.data(), GL_STREAM_DRAW);
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, tiles_.name());
    for (std::size_t first = 0; first < slopes_.size(); first += group_) {
      const std::size_t count = std::min(group_, slopes_.size() - first);
      openWindows(gl, run, first, count);
      for (std::size_t m = 0; m < run.slices.size(); ++m) step(gl, run, m, first, count);
    }
    gl.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    open_ = run.windows;
    frame.clock.lap(&PassTimes::windowsMs);
  }

  void drawExtinction(Frame& frame, const LightRun& run) {
    const GlFunctions& gl = frame.gl;
    const std::span<const SliceDraw> draws = drawsOf(lightPolygons_->draws(), run);
    const float nothing[4] = {};
    gl.Disable(GL_SCISSOR_TEST);
    gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.ClearNamedFramebufferfv(extinctionTarget_.name(), GL_COLOR, 0, nothing);
    if (draws.empty()) return;
    gl.BindFramebuffer(GL_FRAMEBUFFER, extinctionTarget_.name());
    gl.Viewport(0, 0, lattice_.size.x, lattice_.size.y);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_STENCIL_TEST);
    gl.Disablei(GL_BLEND, 0);
    absorb_.current().use();
    lightPolygons_->bind();
    frame.fragments.begin();
    for (std::size_t i = 0; i < draws.size();) {
      SliceDraw merged = draws[i];
      for (++i; i < draws.size() && draws[i].texture == merged.texture; ++i) merged.indices += draws[i].indices;
      bindVolume(frame, merged.texture);
      lightPolygons_->draw(merged.firstIndex, merged.indices);
    }
    frame.fragments.end();
  }

  void setWindows(GlProgram& program, const LightRun& run, std::size_t first, std::size_t count) const {
    std::vector<glm::vec4> windows;
    for (std::size_t k = first; k < first + count; ++k) {
      const glm::ivec2 texel(run.windows[k].first % glm::vec<2, std::int64_t>(windowSize_));
      windows.emplace_back(glm::vec2(run.windows[k].size),
                           glm::vec2(texel + windowSize_ * glm::ivec2(glm::lessThan(texel, glm::ivec2(0)))));
    }
    program.set("window", windows);
    program.set("window_size", glm::vec2(windowSize_));
    program.set("first_direction", static_cast<int>(first));
  }

  void openWindows(const GlFunctions& gl, const LightRun& run, std::size_t first, std::size_t count) {
    GlProgram& program = openWindows_.current();
    std::vector<glm::vec4> before;
    glm::ivec2 largest(0);
    for (std::size_t k = first; k < first + count; ++k) {
      const glm::vec<2, std::int64_t> from = open_[k].first - run.windows[k].first;
      before.emplace_back(glm::vec2(from), glm::vec2(from + glm::vec<2, std::int64_t>(open_[k].size)));
      largest = glm::max(largest, run.windows[k].size);
    }
    setWindows(step_.current(), run, first, count);
    step_.current().set("radiance", std::span(radiance_).subspan(first, count));
    step_.current().set("direction_count", static_cast<int>(count));
    step_.current().set("add", first > 0 ? 1 : 0);
    if (largest.x == 0 || largest.y == 0) return;
    setWindows(program, run, first, count);
    program.set("window_before", before);
    program.use();
    gl.DispatchCompute(tilesAlong(largest.x), tilesAlong(largest.y), static_cast<GLuint>(count));
    gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }

  // Through slice m of the run.
  void step(const GlFunctions& gl, const LightRun& run, std::size_t m, std::size_t first, std::size_t count) {
    const auto slice = static_cast<std::size_t>(run.slices[m]);
    const auto tiles = static_cast<int>(firstTile_[slice + 1] - firstTile_[slice]);
    if (tiles == 0) return;
    GlProgram& program = step_.current();
    std::vector<glm::vec4> paths;
    for (std::size_t k = first; k < first + count; ++k) {
      const glm::dvec2 shift = glm::floor(extents_.depths[slice] / lattice_.texel * slopes_[k].slope + roundings_[k]);
      const double stretch = slopes_[k].stretch;
      paths.emplace_back(glm::vec2(glm::dvec2(lattice_.first) - glm::dvec2(run.windows[k].first) + shift), stretch,
                         1 / (1 + stretch));
    }
    program.set("path", paths);
    program.set("first_tile",
                static_cast<int>(firstTile_[slice] - firstTile_[static_cast<std::size_t>(run.slices.front())]));
    program.set("layer", static_cast<int>(m));
    program.use();
    // Every driver takes so many along an axis.
    const int columns = std::min(tiles, 32768);
    program.set("tile_count", tiles);
    gl.DispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>((tiles + columns - 1) / columns), 1);
    gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }

  static GLuint tilesAlong(int texels) { return static_cast<GLuint>((texels + kTile - 1) / kTile); }

  struct Sizes {
    glm::ivec2 lattice{0}, window{0};
    int directions = 0, slices = 0;
    bool coloured = false;
    bool operator==(const Sizes&) const = default;
  };

  SpecialisedProgram absorb_{"shade/light_slice.vert", "shade/light_extinction.frag"};
  SpecialisedProgram openWindows_{"shade/window_open.comp"};
  SpecialisedProgram step_{"shade/window_step.comp"};
  SpecialisedProgram eye_{"shade/ordinates.vert", "shade/ordinates.frag"};
  EyeSweep sweep_;
  std::vector<LightSlope> slopes_;
  std::vector<glm::dvec2> roundings_;  // by direction, see RenderSample
  std::vector<glm::vec4> radiance_;    // by direction: rgb, and its share of the light
  glm::dvec3 light_{0};                // sum of the radiances
  double brightest_ = 1;               // see SlicePass
  bool coloured_ = false;              // the directions' radiances differ in more than brightness
  std::optional<Camera> aimedFrom_;    // whose directions of the scene these are
  std::size_t group_ = 1;              // directions that one shader takes through a slice
  int slicesTogether_ = 1;
  LightLattice lattice_;
  LightExtents extents_;
  std::vector<Rectangle> needed_;
  IndexView lightView_;
  std::vector<glm::dvec4> lightPlanes_;
  ProxySlices lightSlices_;
  std::optional<PolygonBuffer> lightPolygons_;
  std::optional<LightPlanner> planner_;
  std::vector<LightRun> runs_;
  glm::ivec2 windowSize_{1};
  Sizes sizes_;
  int windowBits_ = 32;
  GlTexture extinction_, visibility_, weights_, windows_;
  GlFramebuffer extinctionTarget_;
  GlBuffer tiles_;
  std::vector<GLuint> tileList_;        // of all slices
  std::vector<std::size_t> firstTile_;  // by slice, and one more
  std::vector<LightWindow> open_;       // as the run before has left them
};

}  // namespace

std::unique_ptr<SlicePass> makeOrdinatesPass() { return std::make_unique<OrdinatesPass>(); }

}  // namespace umbrick
