// What the passes of one picture share.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "shade/polygon_buffer.h"
#include "shade/render_targets.h"
#include "shade/transfer_lookup.h"
#include "umbrick/gl/program.h"
#include "umbrick/scene/scene.h"
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

struct Frame {
  const GlFunctions& gl;
  const Scene& scene;
  Camera camera;
  IndexView view;
  std::vector<glm::dvec4> planes;  // in view coordinates
  ProxySlices slices;
  const BrickAtlas& atlas;
  const TransferLookup& transfer;
  const RenderTargets& targets;
  const PolygonBuffer& polygons;
  FragmentCounter fragments;

  glm::ivec2 size() const { return {camera.width, camera.height}; }
};

/// Constants of every shader that evaluates slabs.
ShaderConstants slabConstants(const Frame& frame);
/// Sets what ray.glsl, clip.glsl and medium.glsl read.
void setSlabUniforms(GlProgram& program, const Frame& frame);
/// Binds the volume's texture and the transfer function for a draw.
void bindVolume(const Frame& frame, int texture);

/// Draws slices in order; one kind per model.
class SlicePass {
 public:
  virtual ~SlicePass() = default;
  /// Before the first slice of a picture; compiles what changed.
  virtual void begin(Frame& frame) = 0;
  /// Slices [first, last), whose triangles are in frame.polygons.
  virtual void draw(Frame& frame, std::int64_t first, std::int64_t last) = 0;
};

std::unique_ptr<SlicePass> makeEmissionPass();
std::unique_ptr<SlicePass> makeOcclusionPass();

/// Excludes saturated pixels from what follows.
class SaturationTest {
 public:
  explicit SaturationTest(const GlFunctions& gl);
  void run(const Frame& frame);

 private:
  GlProgram program_;
  GlVertexArray nothing_;  // the core profile draws nothing without one
};

/// The program of `fragment` with these constants, compiled again only when they change.
class SpecialisedProgram {
 public:
  SpecialisedProgram(std::string vertex, std::string fragment)
      : vertex_(std::move(vertex)), fragment_(std::move(fragment)) {}
  GlProgram& get(const GlFunctions& gl, const ShaderConstants& constants);
  GlProgram& current() { return *program_; }

 private:
  std::string vertex_, fragment_;
  ShaderConstants constants_;
  std::unique_ptr<GlProgram> program_;
};

}  // namespace umbrick
