// Keeps the light windows in graphics memory: opens them run by run and takes light through the slices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "shade/frame.h"
#include "shade/light_plan.h"

namespace umbrick {

/// Each path, of the view axis and of every direction of the light, has a light window: one layer of a texture that
/// holds what is left of its light. A slice multiplies that by its own transmittance, and before that writes down what
/// arrives on it. This is the visibility, which the eye reads.
class LightWindows {
 public:
  /// @throw InvalidArgument  the driver does not take a light window for each of so many paths
  static void checkCount(const GlFunctions& gl, const LightPaths& paths);
  /// Is called before the first slice of a picture, when no path has met anything yet.
  void begin(const Frame& frame, const LightPlan& plan);
  /// Takes light through the slices of a run. @param extinction  see LightExtinction
  void carry(const GlFunctions& gl, const LightPlan& plan, const LightRun& run, const GlTexture& extinction);
  /// Binds the visibility on the slices of the last run for ordinates.frag.
  void bindVisibility(const GlFunctions& gl) const;

  /// Returns the bytes of a lattice texel of one slice: extinction, weight and visibility.
  static int bytesPerTexel(bool coloured) { return coloured ? 24 : 16; }
  /// Returns the bytes of the windows and of what lies on the lattice, the texture of LightExtinction included.
  std::uint64_t bytes() const;

 private:
  struct Sizes {
    glm::ivec2 lattice{0}, window{0};
    int paths = 0, slices = 0, bits = 32;
    bool coloured = false;
    bool operator==(const Sizes&) const = default;
    GLenum windowFormat() const { return bits == 16 ? GL_R16 : GL_R32F; }
    GLenum visibilityFormat() const { return coloured ? GL_RGBA32F : GL_RG32F; }
  };
  // A group of directions that one call of a shader takes through a slice: [first, first + count) of all.
  struct Group {
    std::size_t first = 0, count = 0;
  };
  static Group groupFrom(std::size_t first, std::size_t directions);

  void makeTextures(const GlFunctions& gl, const Sizes& sizes);
  void bindAll(const GlFunctions& gl, const GlTexture& extinction, std::span<const std::uint32_t> tiles) const;
  void open(const GlFunctions& gl, const LightRun& run);
  void setGroup(const LightPlan& plan, const LightRun& run, const Group& group);
  void step(const GlFunctions& gl, const LightPlan& plan, const LightRun& run, std::size_t m, const Group& group);
  glm::vec4 place(const LightWindow& window) const;

  SpecialisedProgram openProgram_{"shade/window_open.comp"};
  SpecialisedProgram stepProgram_{"shade/window_step.comp"};
  Sizes sizes_;
  GlTexture windows_, visibility_, visibilityWeight_;
  GlBuffer tiles_;
  std::vector<LightWindow> open_;  // by layer, as the run before has left the windows
};

}  // namespace umbrick
