// Draws the rays of a picture through one run of bricks after another.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "shade/frame.h"
#include "shade/ray_runs.h"
#include "shade/render_targets.h"
#include "shade/resident_light.h"
#include "shade/transfer_lookup.h"
#include "shade/voxel_codes.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

/// The buffers of rays: those of a picture, and how many segments a ray was taken through.
struct RayTargets {
  RayTargets(const GlFunctions& gl, const TargetOptions& options);
  std::size_t bytes() const { return picture.bytes() + 4 * pixels(); }
  std::size_t pixels() const {
    return static_cast<std::size_t>(picture.options.width) * static_cast<std::size_t>(picture.options.height);
  }
  void clear(const GlFunctions& gl) const;
  std::uint64_t segments(const GlFunctions& gl) const;

  RenderTargets picture;
  GlTexture count;
  GlFramebuffer all;  // eye, count [, aux], depth
};

/// What all runs of a picture share.
struct RayScene {
  const GlFunctions& gl;
  const ResolvedScene& scene;
  const IndexView& view;
  std::span<const glm::dvec4> planes;  // that cut the medium, view coordinates
  Box medium;                          // outside of which there is nothing to see, index coordinates
  const TransferLookup& transfer;
  const BrickSelection& bricks;
  const ResidentLight* light;                  // null: there is no light volume
  std::span<const LightDirection> coneLights;  // that rays look for from each sample; none: they do not
  const GlTexture* start;                      // as ray_march.frag reads it; null: rays begin at the eye
  const GlTexture* ends;                       // as brick_walk.glsl reads it; null: rays end nowhere
  const VoxelCodes& codes;
  const Bricks& volume;
  const RayTargets& targets;
  const std::function<void(double)>& progress;
};

class RayPass {
 public:
  /// Is called before the first run of a picture; compiles what has changed.
  void begin(const RayScene& rays);
  /// Draws a run behind those before it.
  void draw(const RayScene& rays, const RayFrame& frame, const RayRun& run);
  std::uint64_t bytes() const { return slots_.bytes(); }

  /// Software OpenGL takes no more turns of loops for a pixel.
  static constexpr double kMostTurns = 65535;
  /// Returns how many steps all rays towards the light of a segment may take.
  static double stepsToLight(const RayScene& rays, const RayFrame& frame);

 private:
  void takeLights(const RayScene& rays);
  void endSaturated(const RayScene& rays);
  static double segmentsAtOnce(const RayScene& rays, const RayFrame& frame);
  void setState(const RayScene& rays, const RayRun& run);
  SpecialisedProgram program_{"shade/full_screen.vert", "shade/ray_march.frag"};
  std::optional<SaturationTest> saturation_;
  std::optional<GlVertexArray> nothing_;  // an empty vertex array, since the core profile draws nothing without one
  SlotTable slots_;
  GlTexture coneLights_;  // see cone_light.glsl
  bool first_ = true;     // nothing is drawn yet
};

}  // namespace umbrick
