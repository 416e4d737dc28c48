// Light as a volume: how much of it reaches each voxel is computed before the picture is drawn (resident_light.h), and
// lies in textures beside those of the bricks, with the same slots. A slice reads it where it reads values.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "shade/constants.h"
#include "shade/eye_sweep.h"
#include "shade/resident_light.h"

namespace umbrick {
namespace {

class LightVolumePass : public SlicePass {
 public:
  LightVolumePass(ResidentVolume& volume, LightSweep sweep) : light_(volume, sweep) {}

  void begin(Frame& frame, std::span<const SweepRun> runs) override {
    if (frame.first) light_.beginPicture();
    light_.update(frame.scene, frame.sample, frame.view, frame.planes, frame.transfer, frame.bricks);
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
    light_.require(frame.gl, frame.bricks, run->bricks);
  }

  void draw(Frame& frame, std::int64_t, std::int64_t) override {
    const std::span<const SliceDraw> draws = frame.polygons.draws();
    for (std::size_t begin = 0; begin < draws.size();) {
      std::size_t end = begin + 1;
      while (end < draws.size() && draws[end].texture == draws[begin].texture) ++end;
      frame.gl.BindTextureUnit(kLightUnit, light_.texture(draws[begin].texture));
      sweep_.draw(frame, draws.subspan(begin, end - begin), program_.current());
      begin = end;
    }
  }

  double brightest() const override { return brightest_; }

  void addTo(RenderStats& stats) const override { light_.addTo(stats); }

 private:
  ResidentLight light_;
  std::vector<SweepRun> runs_;
  double brightest_ = 1;  // see SlicePass
  SpecialisedProgram program_{"shade/slice.vert", "shade/light_volume.frag"};
  EyeSweep sweep_;
};

}  // namespace

std::unique_ptr<SlicePass> makeLightVolumePass(ResidentVolume& volume, LightSweep sweep) {
  return std::make_unique<LightVolumePass>(volume, sweep);
}

}  // namespace umbrick
