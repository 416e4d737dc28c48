// Light as a volume: how much of it reaches each voxel is computed before the picture is drawn (umbrick/light), and
// lies in textures beside those of the bricks, with the same slots. A slice reads it where it reads values.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "shade/constants.h"
#include "shade/eye_sweep.h"
#include "shade/light_textures.h"
#include "umbrick/scene/lights.h"

namespace umbrick {
namespace {

class LightVolumePass : public SlicePass {
 public:
  explicit LightVolumePass(const Bricks& volume) : light_(volume) {}

  void begin(Frame& frame, std::span<const SweepRun> runs) override {
    const Stopwatch watch;
    const std::uint64_t most = std::max<std::uint64_t>(frame.scene.bricks.budgetMiB << 20, std::uint64_t{2} << 30);
    const bool computed = light_.update(mediumOf(frame), most);
    if (computed) ++version_;
    lightMs_ = computed ? watch.elapsedMs() : 0;
    runs_.assign(runs.begin(), runs.end());
    const glm::dvec3 whole = light_.whole();
    brightest_ = frame.scene.sampling.bits == 16 ? std::max({1.0, whole.r, whole.g, whole.b}) : 1;
    ShaderConstants constants = slabConstants(frame);
    constants["kColoured"] = light_.coloured();
    GlProgram& program = program_.get(frame.gl, constants);
    setSlabUniforms(program, frame);
    program.set("whole_light", glm::vec3(whole));
    program.set("brightest", static_cast<float>(brightest_));
    sweep_.begin(frame);
  }

  void fill(Frame& frame, std::int64_t first, std::int64_t last) override {
    SlicePass::fill(frame, first, last);
    const auto run = std::ranges::find(runs_, first, &SweepRun::first);
    textures_.require(frame.gl, frame.bricks, light_, version_, run->bricks);
  }

  void draw(Frame& frame, std::int64_t, std::int64_t) override {
    const std::span<const SliceDraw> draws = frame.polygons.draws();
    for (std::size_t begin = 0; begin < draws.size();) {
      std::size_t end = begin + 1;
      while (end < draws.size() && draws[end].texture == draws[begin].texture) ++end;
      frame.gl.BindTextureUnit(kLightUnit, textures_.texture(draws[begin].texture));
      sweep_.draw(frame, draws.subspan(begin, end - begin), program_.current());
      begin = end;
    }
  }

  double brightest() const override { return brightest_; }

  void addTo(RenderStats& stats) const override {
    stats.directions = light_.stats().directions;
    stats.windowUpdates = light_.stats().updates;
    stats.lightSpacing = light_.stats().spacing;
    stats.lightSpacingError = light_.stats().spacingError;
    stats.windowBytes = textures_.bytes();
    stats.textureBytes += textures_.bytes();
    stats.lightMs = lightMs_;
  }

 private:
  LightMedium mediumOf(const Frame& frame) const {
    const bool ofScene = frame.sample.lights.empty();
    LightMedium medium{
        frame.scene.transfer,
        ofScene ? lightDirections(frame.scene, frame.scene.occlusion.ordinates.directions) : frame.sample.lights,
        {},
        {frame.bricks.origins().begin(), frame.bricks.origins().end()},
        frame.scene.occlusion.ordinates.lightSpacing};
    for (const glm::dvec4& plane : frame.planes) {
      const glm::dvec3 n(plane);
      const glm::dvec4 inIndex(glm::dot(n, frame.view.axis[0]), glm::dot(n, frame.view.axis[1]),
                               glm::dot(n, frame.view.axis[2]), glm::dot(n, frame.view.origin) + plane.w);
      if (cutsMedium(inIndex, medium.cells, frame.atlas.layout().interior)) medium.planes.push_back(inIndex);
    }
    return medium;
  }

  LightVolume light_;
  std::uint64_t version_ = 0;
  LightTextures textures_;
  std::vector<SweepRun> runs_;
  double brightest_ = 1;  // see SlicePass
  double lightMs_ = 0;
  SpecialisedProgram program_{"shade/slice.vert", "shade/light_volume.frag"};
  EyeSweep sweep_;
};

}  // namespace

std::unique_ptr<SlicePass> makeLightVolumePass(const Bricks& volume) {
  return std::make_unique<LightVolumePass>(volume);
}

}  // namespace umbrick
