// What the passes of one picture share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "shade/polygon_buffer.h"
#include "shade/render_targets.h"
#include "shade/sweep_plan.h"
#include "shade/transfer_lookup.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/gl/program.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

/// Counts fragments that pass the depth test, over many draws.
class FragmentCounter {
 public:
  FragmentCounter(const GlFunctions& gl, bool enabled) : gl_(gl), enabled_(enabled) {}
  void begin();
  void end();
  std::uint64_t total() const;  // waits for the draws

 private:
  const GlFunctions& gl_;
  bool enabled_;
  std::vector<GlQuery> queries_;
};

/// Wall-clock time of each kind of pass; waits for the driver at every lap, which costs time itself.
class PassClock {
 public:
  PassClock(const GlFunctions& gl, bool enabled) : gl_(gl), enabled_(enabled) {}
  void start() { watch_ = Stopwatch(); }
  /// What happened since the start or the last lap was for `pass`.
  void lap(double PassTimes::*pass) {
    if (!enabled_) return;
    gl_.Finish();
    times_.*pass += watch_.elapsedMs();
    watch_ = Stopwatch();
  }
  const PassTimes& times() const { return times_; }

 private:
  const GlFunctions& gl_;
  bool enabled_;
  Stopwatch watch_;
  PassTimes times_;
};

struct Frame {
  const GlFunctions& gl;
  const ResolvedScene& scene;
  Camera camera;
  IndexView view;
  std::vector<glm::dvec4> planes;  // that cut slabs, in view coordinates
  std::vector<glm::dvec4> bounds;  // beyond which there is nothing to draw: those planes and the box of the medium
  ProxySlices slices;
  const BrickSelection& bricks;  // polygons name bricks by their position in it
  const BrickAtlas& atlas;
  const TransferLookup& transfer;
  const RenderTargets& targets;
  PolygonBuffer& polygons;
  FragmentCounter fragments;
  bool reverseBricks = false;  // see RenderOptions
  double voxelEdge = 1;        // shortest, world units
  double diagonal = 1;         // of the volume's domain, world units; the same however it is cut into bricks
  PassClock clock;
  RenderSample sample;

  glm::ivec2 size() const { return {camera.width, camera.height}; }
};

/// Constants of every shader that evaluates slabs.
ShaderConstants slabConstants(const Frame& frame);
/// Sets what ray.glsl, clip.glsl and medium.glsl read.
void setSlabUniforms(GlProgram& program, const Frame& frame);
/// Likewise for slabs seen in another way than by the camera. @param planes  in the coordinates of that view
void setSlabUniforms(GlProgram& program, const Frame& frame, const IndexView& view, std::span<const glm::dvec4> planes);
/// Binds the volume's texture and the transfer function for a draw.
void bindVolume(const Frame& frame, int texture);

/// Draws slices in order; one kind per model.
class SlicePass {
 public:
  virtual ~SlicePass() = default;
  /// Once the slices of a picture are cut.
  virtual void plan(Frame&) {}
  /// Slices, as many as the frame's, whose bricks draw() needs besides those that the eye sees; null: none.
  virtual const ProxySlices* occluders() const { return nullptr; }
  /// Before the first slice of a picture; compiles what changed. @param runs  of slices that will be drawn together
  virtual void begin(Frame& frame, std::span<const SweepRun> runs) = 0;
  /// Puts the triangles of slices [first, last), whose bricks are resident, into frame.polygons.
  virtual void fill(Frame& frame, std::int64_t first, std::int64_t last);
  /// Slices [first, last), after fill().
  virtual void draw(Frame& frame, std::int64_t first, std::int64_t last) = 0;
  /// Light of this radiance is 1 in the eye buffer: 1, or more where fixed point would cut brighter light off.
  virtual double brightest() const { return 1; }
  /// What is special about the last picture.
  virtual void addTo(RenderStats&) const {}
};

std::unique_ptr<SlicePass> makeEmissionPass();
std::unique_ptr<SlicePass> makeOcclusionPass();
std::unique_ptr<SlicePass> makeOrdinatesPass();

/// Excludes saturated pixels from what follows.
class SaturationTest {
 public:
  explicit SaturationTest(const GlFunctions& gl);
  void run(const Frame& frame);

 private:
  GlProgram program_;
  GlVertexArray nothing_;  // the core profile draws nothing without one
};

/// The program of `vertex` and `fragment`, or of a compute shader, with these constants, compiled again only when they
/// change.
class SpecialisedProgram {
 public:
  SpecialisedProgram(std::string vertex, std::string fragment)
      : vertex_(std::move(vertex)), fragment_(std::move(fragment)) {}
  explicit SpecialisedProgram(std::string compute) : compute_(std::move(compute)) {}
  GlProgram& get(const GlFunctions& gl, const ShaderConstants& constants);
  GlProgram& current() { return *program_; }

 private:
  std::string vertex_, fragment_, compute_;
  ShaderConstants constants_;
  std::unique_ptr<GlProgram> program_;
};

}  // namespace umbrick
