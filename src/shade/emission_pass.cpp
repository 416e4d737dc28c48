// Draws emission and absorption: each slice blends into the eye buffer and needs nothing of other slices.
// SPDX-License-Identifier: Apache-2.0
#include "shade/eye_sweep.h"

namespace umbrick {
namespace {

class EmissionPass : public SlicePass {
 public:
  void begin(Frame& frame, std::span<const SweepRun>) override {
    setSlabUniforms(program_.get(frame.gl, slabConstants(frame)), frame);
    sweep_.begin(frame);
  }
  void draw(Frame& frame, std::int64_t, std::int64_t) override {
    sweep_.draw(frame, frame.polygons.draws(), program_.current());
  }

 private:
  SpecialisedProgram program_{"shade/slice.vert", "shade/emission.frag"};
  EyeSweep sweep_;
};

}  // namespace

std::unique_ptr<SlicePass> makeEmissionPass() { return std::make_unique<EmissionPass>(); }

}  // namespace umbrick
