// What techniques on the CPU share: a scene's visible bricks in memory, its table of the medium, its light.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sweep/brick_bands.h"
#include "sweep/brick_light.h"
#include "sweep/brick_shading.h"
#include "sweep/brick_voxels.h"
#include "sweep/medium_table.h"
#include "sweep/swept_frame.h"
#include "umbrick/core/box.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/scene/lights.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Tells whether techniques on the CPU render a scene: the models emission, cone, ambient and lights, the last three
/// with light volumes, or by rays with cone rays.
bool sweptSupports(const SceneSettings& scene, Technique technique);

/// Keeps what follows from a scene as long as the scene does.
class SweptScene {
 public:
  SweptScene(const Bricks& volume, Technique technique);

  /// Takes another scene. @param before  null: this is the first one
  /// @throw InvalidArgument  one that techniques on the CPU do not render; a brick exceeds its memory budget
  void update(const ResolvedScene& next, const ResolvedScene* before);

  /// Prepares a picture: light, and where the medium ends. Fills in what `stats` says of them.
  void prepare(const ResolvedScene& scene, const RenderSample& sample, RenderStats& stats);
  /// Draws the rows of a picture: all at once, or in bands whose bricks fit the memory budget where not all do.
  /// @param rows      of the picture; bands begin at multiples of `multiple`
  /// @param rowsOf    returns where a brick is seen
  /// @param draw      draws the rows begin <= row < end. The bricks that they need are held, with their light.
  /// @throw InvalidArgument  the bricks of the least band do not fit
  void drawInBands(const ResolvedScene& scene, int rows, int multiple,
                   const std::function<RowSpan(const Brick& brick)>& rowsOf,
                   const std::function<void(int begin, int end)>& draw, RenderStats& stats);
  bool isEmpty() const { return visible_.empty(); }
  /// Directions in which cone rays look for the prepared picture's light, and half-spaces of what they meet.
  const std::vector<LightDirection>& coneDirections() const { return coneDirections_; }
  const std::vector<glm::dvec4>& lightPlanes() const { return lightPlanes_; }
  const MediumTable& table() const { return *table_; }

  const BrickVoxels& voxels() const { return voxels_; }
  /// What all rays of the prepared picture share. @param aux  also light and depth
  SweptFrame frame(const ResolvedScene& scene, bool aux) const;
  /// The space of cells in visible bricks, index coordinates. @pre !isEmpty()
  Box visibleBox() const;
  const IndexView& view() const { return view_; }
  /// Half-spaces that the medium lies in, index coordinates.
  const std::vector<glm::dvec4>& planes() const { return planes_; }
  const Bricks& volume() const { return voxels_.volume(); }

  /// Fills in a pixel: colour is premultiplied, of light 1; aux is opacity times light, and times depth; emitted is
  /// what reaches the eye of the light of a second grid.
  void storePixel(const ResolvedScene& scene, std::size_t at, const glm::vec4& colour, const glm::vec2& aux,
                  Picture& picture, const glm::vec3& emitted = glm::vec3(0)) const;

 private:
  double largestExtinction() const;
  void shade();
  std::uint64_t mediaBytes(bool classified) const;
  ShownValues shown() const { return {*table_, emission_ ? &*emission_ : nullptr}; }

  void checkMethod(const ResolvedScene& next) const;

  Technique technique_;
  BrickVoxels voxels_;
  BrickLight light_;
  BrickShading shading_;
  std::optional<MediumTable> table_;
  std::optional<MediumTable> emission_;  // of the second grid; none: nothing emits
  bool backgroundVisible_ = false;
  std::vector<Brick> visible_;
  bool inBands_ = false;      // not all of them are held at once
  double loadMs_ = 0;         // of bricks since the last picture
  std::uint64_t loaded_ = 0;  // their number
  IndexView view_;
  std::vector<glm::dvec4> planes_, lightPlanes_;
  std::vector<LightDirection> coneDirections_;
  int lights_ = 0;      // channels of light beside the voxels; 0 where all is lit alike
  glm::vec3 whole_{1};  // light that arrives where nothing is in the way
};

/// Returns how many samples a scene takes between two slices of voxels, of which its slabs have segments; at most 8.
/// @return before rounding
double segmentsPerVoxel(const ResolvedScene& scene, const Bricks& volume);
inline constexpr int kMostPerVoxel = 8;

/// An empty picture of the scene's size. @param layers  also those of Picture besides colour
Picture emptyPicture(const ResolvedScene& scene, bool layers);

}  // namespace umbrick
