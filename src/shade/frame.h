// What the passes of one picture share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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
#include "umbrick/slice/stack_slices.h"

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

/// Measures the wall-clock time of each kind of pass. It waits for the driver at every lap, which costs time itself.
class PassClock {
 public:
  PassClock(const GlFunctions& gl, bool enabled) : gl_(gl), enabled_(enabled) {}
  void start() { watch_ = Stopwatch(); }
  /// Books the time since the start or the last lap to `pass`.
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

/// Tells how far a picture is, where somebody asks. Only a wait for the driver tells, so it asks after some slices.
class SweepProgress {
 public:
  SweepProgress(const GlFunctions& gl, const std::function<void(double)>& report) : gl_(gl), report_(report) {}
  /// @param share  of the picture that these slices are, after `done` of it
  void begin(std::int64_t slices, const glm::ivec2& size, double done = 0, double share = 1);
  /// Is called when the slices before this one have been handed to the driver, whether or not there was something to
  /// draw on them. @param slice  counted from 0 at the nearest
  void reached(std::int64_t slice);

 private:
  const GlFunctions& gl_;
  const std::function<void(double)>& report_;
  std::int64_t slices_ = 1, interval_ = 1, told_ = 0;
  double done_ = 0, share_ = 1;
};

struct Frame {
  const GlFunctions& gl;
  const ResolvedScene& scene;
  Camera camera;
  IndexView view;
  std::vector<glm::dvec4> planes;  // planes that cut slabs, in view coordinates
  std::vector<glm::dvec4> bounds;  // nothing is drawn beyond these: `planes` and the medium's box
  ProxySlices slices;
  BrickSelection& bricks;  // the bricks by their position in it, which is how polygons name them
  const BrickAtlas& atlas;
  const TransferLookup& transfer;
  const RenderTargets& targets;
  PolygonBuffer& polygons;
  FragmentCounter fragments;
  bool reverseBricks = false;  // see RenderOptions
  double voxelEdge = 1;        // shortest edge of a voxel, world units
  double diagonal = 1;         // of the volume's domain, world units; the same however it is cut into bricks
  PassClock clock;
  RenderSample sample;
  std::optional<StackAim> stack;  // of the slices; none: they lie across the view
  bool first = true;              // there are no slices of another stack before these
  SweepProgress progress;

  glm::ivec2 size() const { return {camera.width, camera.height}; }
};

/// Returns the constants of every shader that evaluates slabs.
ShaderConstants slabConstants(const Frame& frame);
/// Sets the uniforms that ray.glsl, clip.glsl and medium.glsl read.
void setSlabUniforms(GlProgram& program, const Frame& frame);
/// Sets the same uniforms for slabs in a view other than the camera's. @param planes  in the coordinates of that view
void setSlabUniforms(GlProgram& program, const Frame& frame, const IndexView& view, std::span<const glm::dvec4> planes);
/// Binds the volume's texture and the transfer function for a draw.
void bindVolume(const Frame& frame, int texture);

/// Draws slices in order. There is one kind of slice pass for each way of lighting.
class SlicePass {
 public:
  virtual ~SlicePass() = default;
  /// Is called once the slices of a picture are cut.
  virtual void plan(Frame&) {}
  /// Returns the slices, as many as the frame's, whose bricks draw() needs besides those that the eye sees; null: none.
  virtual const ProxySlices* occluders() const { return nullptr; }
  /// Is called before the first slice of a picture; compiles what has changed. @param runs  slices to be drawn together
  virtual void begin(Frame& frame, std::span<const SweepRun> runs) = 0;
  /// Puts the triangles of slices [first, last), whose bricks are resident, into frame.polygons.
  virtual void fill(Frame& frame, std::int64_t first, std::int64_t last);
  /// Draws slices [first, last), after fill().
  virtual void draw(Frame& frame, std::int64_t first, std::int64_t last) = 0;
  /// Returns the radiance that is 1 in the eye buffer: 1, or more where fixed point would cut brighter light off.
  virtual double brightest() const { return 1; }
  /// Adds to the statistics what only this kind of pass knows of the last picture.
  virtual void addTo(RenderStats&) const {}
};

std::unique_ptr<SlicePass> makeEmissionPass();
std::unique_ptr<SlicePass> makeOcclusionPass();
std::unique_ptr<SlicePass> makeOrdinatesPass();
/// @param volume  outlives the pass
std::unique_ptr<SlicePass> makeLightVolumePass(ResidentVolume& volume, LightSweep sweep);

/// Excludes saturated pixels from everything that is drawn later.
class SaturationTest {
 public:
  explicit SaturationTest(const GlFunctions& gl);
  /// @param saturation  transmittance below which a pixel counts as saturated
  void run(const GlFunctions& gl, const RenderTargets& targets, double saturation);

 private:
  GlProgram program_;
  GlVertexArray nothing_;  // an empty vertex array, since the core profile draws nothing without one
};

/// The program of `vertex` and `fragment`, or of a compute shader, for given constants. It is compiled again only
/// when these change.
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
