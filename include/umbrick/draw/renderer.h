// What every technique of rendering provides: a renderer that lives as long as its volume is looked at.
//
// A new technique is a class that derives from Renderer, in a file of its own in src/shade, and a row in the table of
// techniques (render/techniques.h). How it blends, what depth means to it and how a picture is resolved from its
// buffers are up to the technique.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/names.h"
#include "umbrick/image/exr.h"
#include "umbrick/scene/lights.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Where a renderer on OpenGL computes the light of light volumes, which changes it by no more than rounding.
/// Automatic: on a GPU, where it is used; on the CPU's SIMD where OpenGL runs in software, since both then take the
/// same cores.
enum class LightSweep { automatic, cpu, gl };
inline constexpr Name<LightSweep> kLightSweeps[]{
    {"auto", LightSweep::automatic}, {"cpu", LightSweep::cpu}, {"gl", LightSweep::gl}};

/// Options of what a renderer makes besides colour, and of what it measures.
struct RenderOptions {
  bool visibilityAndDepth = false;  // also make the layers of Picture
  bool countFragments = true;
  bool timePasses = false;     // RenderStats::passes; waiting for each pass makes a picture slower
  bool reverseBricks = false;  // draw the bricks of a slice in the opposite order, which must change nothing
  LightSweep lightSweep = LightSweep::automatic;
  /// Called now and then while a sample of a picture is drawn, with the share of its slices that is done, in [0, 1].
  /// What it throws ends the picture, which then cannot be read; the next draw() begins anew.
  std::function<void(double share)> progress = {};
};

/// Where the time of a sweep goes, in ms.
struct PassTimes {
  double extinctionMs = 0;  // ordinates: drawing bricks into the slices' optical depth on the lattice of the light
  double windowsMs = 0;     // ordinates: taking light through the slices
  double eyeMs = 0;         // drawing bricks for the eye; for dos, light as well
};

struct RenderStats {
  std::int64_t slices = 0;        // planes between the nearest and the farthest visible brick
  std::size_t bricks = 0;         // bricks of the volume
  std::size_t visibleBricks = 0;  // bricks that culling leaves
  std::size_t polygons = 0;
  std::uint64_t fragments = 0;       // fragments of bricks that passed the depth test, in all passes; 0: not counted
  std::size_t brickSlots = 0;        // slots that the visible bricks take; bricks of one value share one
  std::uint64_t uploadedBricks = 0;  // bricks uploaded for this picture; 0 where all were resident already
  std::uint64_t textureBytes = 0;    // of the textures that hold bricks
  int textures = 0;                  // number of textures that hold bricks
  int textureEdge = 0;               // longest edge of those textures, texels
  std::uint64_t bufferBytes = 0;     // of the buffers for eye, occlusion, depth and layers
  int directions = 0;                // ordinates, light-volume: number of directions of the light
  double windowTexel = 0;            // ordinates: edge of a texel of the windows, world units
  // ordinates: of the windows and of what light is computed on, part of bufferBytes; light-volume: of the textures of
  // light, part of textureBytes
  std::uint64_t windowBytes = 0;
  std::uint64_t windowUpdates = 0;  // ordinates, light-volume: texels that light was taken through slices in
  double lightMs = 0;               // light-volume: to compute light; 0 where it was there already
  int lightSpacing = 0;             // light-volume: voxels between places of light
  double lightSpacingError = 0;     // light-volume: of light at every second voxel, root mean square, an estimate
  bool lightOnGl = false;           // light-volume: light was computed by OpenGL, not by the CPU
  std::string lightNote;            // light-volume: why OpenGL left light to the CPU, which it should have computed
  PassTimes passes;                 // only when asked for
  double formatError = 0;           // largest |voxel - texel|, grid units
  double geometryMs = 0;            // to cut slices into polygons
  double uploadMs = 0;              // to bring bricks and polygons to textures and buffers
  double sweepMs = 0;               // to draw, until the last fragment is done
  double readMs = 0;                // to bring the picture back to memory
};

/// The choices that are free for a picture. Pictures of other samples have other errors, so that the mean of several
/// has a smaller one. The defaults are those of a single picture.
struct RenderSample {
  std::vector<LightDirection> lights;  // directions for ordinates; empty: lightDirections() of the scene
  double phase = 0.5;  // place of the slices, see ProxySlices; 1/2 where less than a slab is between eye and volume
  glm::dvec2 latticeShift{0};  // ordinates: shift of the lattice of the light, texels
  glm::dvec2 rounding{0.5};    // ordinates: what is added to shifts before they are cut to whole texels, in [0, 1)
  glm::dvec2 pixel{0.5};       // place in each pixel through which it is seen, in [0, 1]^2; 1/2: the centre
};

/// Returns the directions of a sample, or else those of its scene.
std::vector<LightDirection> lightsOf(const ResolvedScene& scene, const RenderSample& sample);

struct Picture {
  Image colour;      // linear premultiplied RGBA
  Image visibility;  // 1 channel: V weighted by opacity, so that V / A is the mean visibility along the ray
  Image depth;    // 1 channel: mean depth along the view axis, world units, weighted by opacity; infinite where A is 0
  Image opacity;  // 1 channel, made with the two above: A without the background, by which depths are averaged
  /// What other modes than integrate know of a pixel besides:
  ///   value     of projections, 1 channel: the number itself; where a ray meets nothing, that of empty space. Of
  ///             isosurfaces, made with the layers above: the value of the nearest surface; NaN where there is none
  ///   position  of isosurfaces, made with them: where the nearest surface is, world units; NaN where there is none
  ///   normal    the same: its normal in the world, on the viewer's side
  std::vector<ImageLayer> layers;
  RenderStats stats;
};

/// How a renderer samples a scene along its rays, from which the error of pictures is estimated.
struct RaySampling {
  /// The distance between samples, world units, or what else is halved where a scene is made twice as fine: it tells
  /// how scenes compare.
  double spacing = 0;
  double voxelEdge = 0;  // the shortest edge of a voxel, world units
  /// Errors fall with a power of the distance that is between these two: with the least at edges of solid medium, with
  /// the most where values run smoothly.
  double leastOrder = 1, mostOrder = 2;
};

/// Makes pictures of one volume. Scenes change by setters, which do no more than the change asks for: camera, theta,
/// clip planes, lights and the size of the picture upload nothing, and another transfer function uploads the bricks
/// that became visible and are not resident.
///
/// The volume was made resident with a texel format and a memory budget; other ones in a later scene have no effect.
class Renderer {
 public:
  virtual ~Renderer() = default;

  const ResolvedScene& scene() const { return *scene_; }
  /// Takes another scene of the same volume. When this throws, the renderer keeps the scene that it had.
  /// @throw InvalidArgument  the technique cannot render the scene; the message says what it can render
  /// @throw GlError
  void setScene(const ResolvedScene& scene);

  // Each of these setters changes one part of the scene and throws as setScene().
  void setCamera(const Camera& camera);
  void setTransfer(const TransferFunction& transfer);
  void setClip(const std::vector<ClipPlane>& planes, const std::optional<Box>& box);
  void setLight(Model model, Method method, const std::vector<LightSource>& sources);
  void setOcclusion(const OcclusionOptions& occlusion);
  void setSampling(const SamplingOptions& sampling);

  /// Tells how it would sample a scene of its volume; none where the bricks were not cut for such a scene.
  virtual std::optional<RaySampling> sampling(const ResolvedScene& scene) const = 0;

  /// Draws the scene into the renderer's own buffers, with one ray a pixel.
  /// @throw GlError, InvalidArgument
  virtual void draw(const RenderSample& sample = {}) = 0;
  /// Returns what was drawn last. @pre draw()
  virtual Picture read() = 0;
  /// Draws and reads. Where the scene asks for several samples a pixel (sampling.pixelSamples) so many pictures are
  /// drawn through other places in the pixels, see pixelPoints, and averaged: premultiplied colour and V as they are,
  /// depth by opacity. Times and counts are then sums over these pictures.
  /// @param beforeEach  is called with the number of each of these pictures before it is drawn, and may move the
  ///   camera, for a picture that is taken while it moves: see pixelTimes. It stays where it was moved last.
  Picture render(const RenderSample& sample = {}, const std::function<void(std::size_t index)>& beforeEach = {});

 protected:
  /// Prepares for a scene, while scene() is still the one before, or none is set. Where this throws,
  /// nothing has changed.
  virtual void update(const ResolvedScene& next) = 0;
  /// Tells whether there is a scene before the one that update() is called for.
  bool hasScene() const { return scene_.has_value(); }

 private:
  /// Takes the scene with an edit.
  template <class Edit>
  void change(const Edit& edit);

  std::optional<ResolvedScene> scene_;
};

}  // namespace umbrick
