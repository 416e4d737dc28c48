// Discrete ordinates: one transmittance per direction of the light, carried along its paths. On a slice at depth s the
// path of direction k through X is texel U = X + s slope_k of a window, the same on every slice: slices only multiply
// what is there, so nothing is resampled on the way, empty space costs nothing, and what is off the screen occludes.
// Shifts are rounded to whole texels, each slice by itself: a path then meets lattice texels and not mixtures of them,
// off by less than a texel and by nothing on average. Interpolation would blur occluders more than that, and costs
// more.
#include <algorithm>
#include <glm/vector_relational.hpp>
#include <optional>
#include <string>

#include "shade/constants.h"
#include "shade/eye_sweep.h"
#include "shade/light_plan.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/lights.h"

namespace umbrick {
namespace {

constexpr int kMostDirections = 64;  // that one shader takes through a slice

class OrdinatesPass : public SlicePass {
 public:
  void plan(Frame& frame) override {
    aim(frame);
    checkCount(frame);
    light_.roundings = shiftRoundings(light_.aimed.paths.lights.size(), frame.sample.rounding);
    origins_.clear();
    for (const Brick& brick : frame.atlas.bricks()) origins_.push_back(brick.origin);
    const double texel =
        latticeTexel(frame.scene.occlusion.scale, frame.slices.spacing, frame.voxelEdge, frame.diagonal);
    GLint mostTexels = 0;
    frame.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &mostTexels);
    light_.geometry = lightGeometry(volumeOf(frame), light_.aimed.paths, texel, frame.sample.latticeShift, mostTexels);
  }
  const ProxySlices* occluders() const override { return &light_.geometry.slices; }

  void begin(Frame& frame, std::span<const SweepRun> runs) override {
    const LightPlanner planner(light_.geometry.extents, light_.aimed.paths);
    const glm::dvec2 texels(light_.geometry.lattice.size);
    light_.runs = planLightRuns(planner, runs, latticeBytes() * texels.x * texels.y);
    light_.tiles = latticeTiles(light_.geometry, volumeOf(frame));
    makeTextures(frame);
    compile(frame);
    sweep_.begin(frame);
    if (!tiles_) tiles_ = GlBuffer(frame.gl);
    open_.assign(slopes_.size(), {});
  }

  void fill(Frame& frame, std::int64_t first, std::int64_t last) override {
    std::vector<int> eye(static_cast<std::size_t>(last - first), -1), light(eye);
    for (const LightRun& run : light_.runs.within(first, last))
      for (std::size_t m = 0; m < run.slices.size(); ++m) {
        const auto at = static_cast<std::size_t>(run.slices[m] - first);
        eye[at] = static_cast<int>(m);
        const bool occludes = !light_.geometry.extents.occluding[static_cast<std::size_t>(run.slices[m])].empty();
        if (occludes) light[at] = static_cast<int>(m);
      }
    frame.polygons.fill(frame.slices, first, last, frame.view, frame.atlas, frame.reverseBricks, eye);
    lightPolygons_->fill(light_.geometry.slices, first, last, light_.geometry.view, frame.atlas, frame.reverseBricks,
                         light);
  }

  void draw(Frame& frame, std::int64_t first, std::int64_t last) override {
    for (const LightRun& run : light_.runs.within(first, last)) {
      light(frame, run);
      const std::span<const SliceDraw> draws = frame.polygons.drawsOf(run.slices.front(), run.slices.back() + 1);
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
    stats.windowTexel = light_.geometry.lattice.texel;
    stats.windowBytes =
        texels(light_.runs.windowSize) * slopes_.size() * static_cast<std::uint64_t>(windowBits_) / 8 +
        texels(light_.geometry.lattice.size) * static_cast<std::uint64_t>(light_.runs.slicesTogether * latticeBytes());
    stats.bufferBytes += stats.windowBytes;
    stats.windowUpdates =
        light_.tiles.places.size() * static_cast<std::uint64_t>(kLatticeTile * kLatticeTile) * slopes_.size();
  }

 private:
  LitVolume volumeOf(const Frame& frame) const {
    return {frame.view, frame.slices, origins_, frame.atlas.layout().interior, frame.planes, frame.bounds};
  }

  // Directions of the sample, or of the scene: these are kept for the next picture from the same camera, since an
  // environment map takes long to walk.
  void aim(const Frame& frame) {
    const bool ofScene = frame.sample.lights.empty();
    if (ofScene && aimedFrom_ == frame.camera) return;
    Scene scene = frame.scene;
    scene.camera = frame.camera;
    light_.aimed = aimLight(ofScene ? lightDirections(scene, scene.occlusion.directions) : frame.sample.lights,
                            cameraFrame(frame.camera));
    const glm::dvec3 whole = light_.aimed.whole;
    brightest_ = scene.sampling.bits == 16 ? std::max({1.0, whole.r, whole.g, whole.b}) : 1;
    aimedFrom_.reset();
    if (ofScene) aimedFrom_ = frame.camera;
    // The shaders take the view axis as the first direction.
    slopes_ = {light_.aimed.paths.view};
    slopes_.insert(slopes_.end(), light_.aimed.paths.lights.begin(), light_.aimed.paths.lights.end());
    radiance_ = {glm::vec4(0)};
    radiance_.insert(radiance_.end(), light_.aimed.radiance.begin(), light_.aimed.radiance.end());
    group_ = std::min<std::size_t>(kMostDirections, slopes_.size());
  }

  void checkCount(const Frame& frame) const {
    GLint layers = 0;
    frame.gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    const auto most = static_cast<std::size_t>(layers) - 1;
    if (light_.aimed.paths.lights.size() > most)
      throw InvalidArgument("directions: the light has " + std::to_string(light_.aimed.paths.lights.size()) +
                            ", beyond the driver's limit of " + std::to_string(most));
  }

  static std::vector<LightWindow> windowsOf(const LightRun& run) {
    std::vector<LightWindow> windows;
    run.forEachWindow([&](const LightWindow& window) { windows.push_back(window); });
    return windows;
  }

  void makeTextures(const Frame& frame) {
    const GlFunctions& gl = frame.gl;
    if (!lightPolygons_) lightPolygons_.emplace(gl);
    const Sizes sizes{light_.geometry.lattice.size, light_.runs.windowSize, static_cast<int>(slopes_.size()),
                      light_.runs.slicesTogether, light_.aimed.coloured};
    if (sizes_ == sizes) return;
    sizes_ = {};  // until all are made
    windowBits_ = frame.scene.occlusion.bits;
    const auto array = [&](GLenum kind, const glm::ivec2& size, int layers, GLenum filter) {
      return makeTextureArray(gl, kind, size.x, size.y, layers, filter);
    };
    extinction_ = array(GL_R32F, light_.geometry.lattice.size, light_.runs.slicesTogether, GL_NEAREST);
    extinctionTarget_ = makeFramebuffer(gl, {extinction_.name()});
    weights_ = array(GL_R32F, light_.geometry.lattice.size, light_.runs.slicesTogether, GL_LINEAR);
    visibility_ = array(visibilityFormat(), light_.geometry.lattice.size, light_.runs.slicesTogether, GL_LINEAR);
    windows_ = array(windowFormat(frame), light_.runs.windowSize, static_cast<int>(slopes_.size()), GL_NEAREST);
    sizes_ = sizes;
  }

  // Of a texel of one slice: extinction, weight and visibility.
  int latticeBytes() const { return light_.aimed.coloured ? 24 : 16; }
  GLenum visibilityFormat() const { return light_.aimed.coloured ? GL_RGBA32F : GL_RG32F; }
  static GLenum windowFormat(const Frame& frame) { return frame.scene.occlusion.bits == 16 ? GL_R16 : GL_R32F; }

  void compile(const Frame& frame) {
    const GlFunctions& gl = frame.gl;
    const ShaderConstants windows{{"kDirections", static_cast<int>(group_)},
                                  {"kFixedPoint", frame.scene.occlusion.bits == 16},
                                  {"kColoured", light_.aimed.coloured}};
    openWindows_.get(gl, windows);
    step_.get(gl, windows);
    ShaderConstants light = slabConstants(frame);
    light["kPerspective"] = 0;
    setSlabUniforms(absorb_.get(gl, light), frame, light_.geometry.view, light_.geometry.planes);
    ShaderConstants eye = slabConstants(frame);
    eye["kColoured"] = light_.aimed.coloured;
    GlProgram& program = eye_.get(gl, eye);
    setSlabUniforms(program, frame);
    const glm::dvec2 texels(light_.geometry.lattice.size);
    program.set("lattice_map",
                glm::vec4(1.0 / (light_.geometry.lattice.texel * texels),
                          -(glm::dvec2(light_.geometry.lattice.first) + light_.geometry.lattice.shift) / texels));
    program.set("whole_light", glm::vec3(light_.aimed.whole));
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
    const std::span<const std::uint32_t> tiles = light_.tiles.of(run.slices.front(), run.slices.back());
    if (tiles.empty()) return;
    gl.NamedBufferData(tiles_.name(), static_cast<GLsizeiptr>(tiles.size_bytes()), tiles.data(), GL_STREAM_DRAW);
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, tiles_.name());
    for (std::size_t first = 0; first < slopes_.size(); first += group_) {
      const std::size_t count = std::min(group_, slopes_.size() - first);
      openWindows(gl, run, first, count);
      for (std::size_t m = 0; m < run.slices.size(); ++m) step(gl, run, m, first, count);
    }
    gl.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    open_ = windowsOf(run);
    frame.clock.lap(&PassTimes::windowsMs);
  }

  void drawExtinction(Frame& frame, const LightRun& run) {
    const GlFunctions& gl = frame.gl;
    const std::span<const SliceDraw> draws = lightPolygons_->drawsOf(run.slices.front(), run.slices.back() + 1);
    const float nothing[4] = {};
    gl.Disable(GL_SCISSOR_TEST);
    gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.ClearNamedFramebufferfv(extinctionTarget_.name(), GL_COLOR, 0, nothing);
    if (draws.empty()) return;
    gl.BindFramebuffer(GL_FRAMEBUFFER, extinctionTarget_.name());
    gl.Viewport(0, 0, light_.geometry.lattice.size.x, light_.geometry.lattice.size.y);
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
    const std::vector<LightWindow> all = windowsOf(run);
    std::vector<glm::vec4> windows;
    for (std::size_t k = first; k < first + count; ++k) {
      const glm::ivec2 texel(all[k].first % glm::vec<2, std::int64_t>(light_.runs.windowSize));
      windows.emplace_back(glm::vec2(all[k].size),
                           glm::vec2(texel + light_.runs.windowSize * glm::ivec2(glm::lessThan(texel, glm::ivec2(0)))));
    }
    program.set("window", windows);
    program.set("window_size", glm::vec2(light_.runs.windowSize));
    program.set("first_direction", static_cast<int>(first));
  }

  void openWindows(const GlFunctions& gl, const LightRun& run, std::size_t first, std::size_t count) {
    GlProgram& program = openWindows_.current();
    const std::vector<LightWindow> windows = windowsOf(run);
    std::vector<glm::vec4> before;
    glm::ivec2 largest(0);
    for (std::size_t k = first; k < first + count; ++k) {
      const glm::vec<2, std::int64_t> from = open_[k].first - windows[k].first;
      before.emplace_back(glm::vec2(from), glm::vec2(from + glm::vec<2, std::int64_t>(open_[k].size)));
      largest = glm::max(largest, windows[k].size);
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
    const auto tiles = static_cast<int>(light_.tiles.of(run.slices[m], run.slices[m]).size());
    if (tiles == 0) return;
    GlProgram& program = step_.current();
    std::vector<glm::vec4> paths;
    const std::vector<LightWindow> windows = windowsOf(run);
    const double depth = light_.geometry.extents.depths[slice] / light_.geometry.lattice.texel;
    for (std::size_t k = first; k < first + count; ++k) {
      const glm::dvec2 shift = k > 0 ? wholeShift(depth, slopes_[k], light_.roundings[k - 1]) : glm::dvec2(0);
      const double stretch = slopes_[k].stretch;
      paths.emplace_back(glm::vec2(glm::dvec2(light_.geometry.lattice.first) - glm::dvec2(windows[k].first) + shift),
                         stretch, 1 / (1 + stretch));
    }
    program.set("path", paths);
    program.set("first_tile", static_cast<int>(light_.tiles.of(run.slices.front(), run.slices[m]).size()) - tiles);
    program.set("layer", static_cast<int>(m));
    program.use();
    // Every driver takes so many along an axis.
    const int columns = std::min(tiles, 32768);
    program.set("tile_count", tiles);
    gl.DispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>((tiles + columns - 1) / columns), 1);
    gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }

  static GLuint tilesAlong(int texels) { return static_cast<GLuint>((texels + kLatticeTile - 1) / kLatticeTile); }

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
  std::vector<glm::vec4> radiance_;  // by direction: rgb, and its share of the light
  double brightest_ = 1;             // see SlicePass
  std::optional<Camera> aimedFrom_;  // whose directions of the scene these are
  std::size_t group_ = 1;            // directions that one shader takes through a slice
  LightPlan light_;
  std::vector<glm::ivec3> origins_;  // of the bricks
  std::optional<PolygonBuffer> lightPolygons_;
  Sizes sizes_;
  int windowBits_ = 32;
  GlTexture extinction_, visibility_, weights_, windows_;
  GlFramebuffer extinctionTarget_;
  GlBuffer tiles_;
  std::vector<LightWindow> open_;  // as the run before has left them
};

}  // namespace

std::unique_ptr<SlicePass> makeOrdinatesPass() { return std::make_unique<OrdinatesPass>(); }

}  // namespace umbrick
