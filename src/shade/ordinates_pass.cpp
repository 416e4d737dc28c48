// Discrete ordinates: one transmittance per direction of the light, carried along its paths. On a slice at depth s the
// path of direction k through X is texel U = X + s slope_k of a light window, the same on every slice: slices only
// multiply what is there, so nothing is resampled on the way, empty space costs nothing, and what is off the screen
// occludes. Shifts are rounded to whole texels, on each slice separately: a path then meets lattice texels and not
// mixtures of them, and is off by less than a texel and by nothing on average. Interpolation would blur occluders more
// than that, and costs more.
//
//   plan    light_aim, light_geometry   which way light comes, and where on the lattice something is seen or occludes
//   begin   light_plan, lattice_tiles   which slices are lit together, with which windows and in which tiles
//   draw    light_extinction            what the slices of a run dim light by
//           light_windows               takes light through them
//           eye_sweep                   draws them, lit, into the picture
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <glm/vec4.hpp>
#include <optional>

#include "shade/constants.h"
#include "shade/eye_sweep.h"
#include "shade/light_extinction.h"
#include "shade/light_plan.h"
#include "shade/light_windows.h"
#include "umbrick/scene/lights.h"

namespace umbrick {
namespace {

class OrdinatesPass : public SlicePass {
 public:
  void plan(Frame& frame) override {
    aim(frame);
    LightWindows::checkCount(frame.gl, light_.aimed.paths);
    light_.roundings = shiftRoundings(light_.aimed.paths.lights.size(), frame.sample.rounding);
    const double texel =
        latticeTexel(frame.scene.occlusion.ordinates.scale, frame.slices.spacing, frame.voxelEdge, frame.diagonal);
    GLint mostTexels = 0;
    frame.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &mostTexels);
    light_.geometry = lightGeometry(volumeOf(frame), light_.aimed.paths, texel, frame.sample.latticeShift, mostTexels);
  }
  const ProxySlices* occluders() const override { return &light_.geometry.slices; }

  void begin(Frame& frame, std::span<const SweepRun> sweeps) override {
    const LightPlanner planner(light_.geometry.extents, light_.aimed.paths);
    const glm::dvec2 texels(light_.geometry.lattice.size);
    const double bytesPerSlice = LightWindows::bytesPerTexel(light_.aimed.coloured) * texels.x * texels.y;
    light_.runs = planLightRuns(planner, sweeps, bytesPerSlice);
    light_.tiles = latticeTiles(light_.geometry, volumeOf(frame));
    extinction_.begin(frame, light_);
    windows_.begin(frame, light_);
    setEyeProgram(frame);
    sweep_.begin(frame);
  }

  void fill(Frame& frame, std::int64_t first, std::int64_t last) override {
    // The eye looks up the layer of its slice, while light is drawn only where something occludes.
    std::vector<int> eye(static_cast<std::size_t>(last - first), -1), light(eye);
    for (const LightRun& run : light_.runs.within(first, last))
      for (std::size_t m = 0; m < run.slices.size(); ++m) {
        const auto at = static_cast<std::size_t>(run.slices[m] - first);
        eye[at] = static_cast<int>(m);
        const bool occludes = !light_.geometry.extents.occluding[static_cast<std::size_t>(run.slices[m])].empty();
        if (occludes) light[at] = static_cast<int>(m);
      }
    frame.polygons.fill(frame.slices, first, last, frame.view, frame.bricks, frame.reverseBricks, eye);
    extinction_.fill(frame, light_, first, last, light);
  }

  void draw(Frame& frame, std::int64_t first, std::int64_t last) override {
    for (const LightRun& run : light_.runs.within(first, last)) {
      extinction_.draw(frame, run);
      frame.clock.lap(&PassTimes::extinctionMs);
      windows_.carry(frame.gl, light_, run, extinction_.texture());
      frame.clock.lap(&PassTimes::windowsMs);
      const std::span<const SliceDraw> draws = frame.polygons.drawsOf(run.slices.front(), run.slices.back() + 1);
      if (draws.empty()) continue;
      windows_.bindVisibility(frame.gl);
      sweep_.draw(frame, draws, eye_.current());
      frame.clock.lap(&PassTimes::eyeMs);
    }
  }

  double brightest() const override { return brightest_; }

  void addTo(RenderStats& stats) const override {
    const std::uint64_t tileTexels = kLatticeTile * kLatticeTile;
    stats.directions = static_cast<int>(light_.aimed.paths.lights.size());
    stats.windowTexel = light_.geometry.lattice.texel;
    stats.windowBytes = windows_.bytes();
    stats.bufferBytes += stats.windowBytes;
    stats.windowUpdates = light_.tiles.places.size() * tileTexels * light_.aimed.paths.count();
  }

 private:
  LitVolume volumeOf(const Frame& frame) const {
    return {frame.view,   frame.slices, frame.bricks.origins(), frame.atlas.layout().interior,
            frame.planes, frame.bounds};
  }

  // What the directions of a scene depend on.
  struct Aimed {
    Camera camera;
    Model model;
    OcclusionOptions occlusion;
    std::vector<LightSource> lights;
    int bits;
    bool isOf(const ResolvedScene& scene) const {
      return camera == scene.camera && model == scene.model && occlusion == scene.occlusion && lights == scene.lights &&
             bits == scene.sampling.bits;
    }
  };

  // Takes the directions of the sample, or those of the scene. The latter are kept for the next picture of the same
  // light, since it takes long to walk an environment map.
  void aim(const Frame& frame) {
    const bool ofScene = frame.sample.lights.empty();
    const ResolvedScene& scene = frame.scene;
    if (ofScene && aimed_ && aimed_->isOf(scene)) return;
    light_.aimed =
        aimLight(ofScene ? lightDirections(scene, scene.occlusion.ordinates.directions) : frame.sample.lights,
                 cameraFrame(frame.camera));
    const glm::dvec3 whole = light_.aimed.whole;
    brightest_ = scene.sampling.bits == 16 ? std::max({1.0, whole.r, whole.g, whole.b}) : 1;
    aimed_.reset();
    if (ofScene) aimed_ = {scene.camera, scene.model, scene.occlusion, scene.lights, scene.sampling.bits};
  }

  void setEyeProgram(const Frame& frame) {
    ShaderConstants constants = slabConstants(frame);
    constants["kColoured"] = light_.aimed.coloured;
    GlProgram& program = eye_.get(frame.gl, constants);
    setSlabUniforms(program, frame);
    const LightLattice& lattice = light_.geometry.lattice;
    const glm::dvec2 texels(lattice.size);
    program.set("lattice_map",
                glm::vec4(1.0 / (lattice.texel * texels), -(glm::dvec2(lattice.first) + lattice.shift) / texels));
    program.set("whole_light", glm::vec3(light_.aimed.whole));
    program.set("brightest", static_cast<float>(brightest_));
  }

  LightPlan light_;
  std::optional<Aimed> aimed_;  // directions of the scene, never those of a sample
  double brightest_ = 1;        // see SlicePass
  LightExtinction extinction_;
  LightWindows windows_;
  SpecialisedProgram eye_{"shade/ordinates.vert", "shade/ordinates.frag"};
  EyeSweep sweep_;
};

}  // namespace

std::unique_ptr<SlicePass> makeOrdinatesPass() { return std::make_unique<OrdinatesPass>(); }

}  // namespace umbrick
