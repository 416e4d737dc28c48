// Renders bricks of a volume by proxy slices, nearest first.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/context.h"
#include "umbrick/image/image.h"
#include "umbrick/scene/lights.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

struct RenderOptions {
  bool visibilityAndDepth = false;  // also make the layers of Picture
  bool countFragments = true;
  bool timePasses = false;     // RenderStats::passes; waiting for each pass makes a picture slower
  bool reverseBricks = false;  // draw the bricks of a slice in the opposite order: must change nothing
  std::uint64_t maxTextureBytes = std::uint64_t{512} << 20;  // see AtlasOptions
  int maxTextureEdge = 0;
  std::uint64_t budgetBytes = 0;  // of bricks' textures; 0: the scene's budget
};

/// Where the time of a sweep goes, ms.
struct PassTimes {
  double extinctionMs = 0;  // ordinates: bricks to the slices' optical depth on the lattice of the light
  double windowsMs = 0;     // ordinates: light through the slices
  double eyeMs = 0;         // bricks to the eye; for dos, light as well
};

struct RenderStats {
  std::int64_t slices = 0;        // planes between the nearest and the farthest visible brick
  std::size_t bricks = 0;         // of the volume
  std::size_t visibleBricks = 0;  // after culling
  std::size_t polygons = 0;
  std::uint64_t fragments = 0;       // of bricks that passed the depth test, all passes; 0 when not counted
  std::uint64_t uploadedBricks = 0;  // in this picture
  std::uint64_t textureBytes = 0;    // of bricks
  int textures = 0;                  // that hold bricks
  int textureEdge = 0;               // longest, texels
  std::uint64_t bufferBytes = 0;     // eye, occlusion, depth and layers
  int directions = 0;                // ordinates: of the light
  double windowTexel = 0;            // ordinates: edge of a texel of the windows, world units
  std::uint64_t windowBytes = 0;     // ordinates: of the windows and of what light is computed on, part of bufferBytes
  std::uint64_t windowUpdates = 0;   // ordinates: texels of windows that slices were taken through
  PassTimes passes;                  // when asked for
  double formatError = 0;            // largest |voxel - texel|, grid units
  double geometryMs = 0;             // cutting slices into polygons
  double uploadMs = 0;               // bricks and polygons to textures and buffers
  double sweepMs = 0;                // drawing, until the last fragment is done
  double readMs = 0;                 // picture back to memory
};

/// Where the freedom of a picture lies: pictures of other samples have other errors, so that their mean has less. The
/// defaults are those of a single picture.
struct RenderSample {
  std::vector<LightDirection> lights;  // of ordinates; empty: lightDirections() of the scene
  double phase = 0.5;          // of the slices, see ProxySlices; 1/2 where less than a slab is between eye and volume
  glm::dvec2 latticeShift{0};  // of ordinates: of the lattice of the light, texels
  glm::dvec2 rounding{0.5};    // of ordinates: what is added to shifts before they are cut to whole texels, in [0, 1)
};

struct Picture {
  Image colour;      // linear premultiplied RGBA
  Image visibility;  // 1 channel: V weighted by opacity, so that V / A is the mean visibility along the ray
  Image depth;  // 1 channel: mean depth along the view axis, world units, weighted by opacity; infinite where A is 0
  RenderStats stats;
};

/// A slab is cut into segments along the view ray. Over a segment the value runs linearly, and the transfer function is
/// integrated stretch by stretch between its control points: opacity exactly, colour with what is behind dimmed by what
/// is in front (Engel, Kraus, Ertl 2001, doi:10.1145/383507.383515, without their table). So the picture depends
/// neither on where values lie nor on how far others lie apart, and no peak of the function is missed.
///
/// For every slab with mean medium (sigma_s, sigma_t), eye path d_e and slice distance d, front to back, from O = 1, C
/// = A = 0:
///   alpha = 1 - exp(-sigma_t d_e)
///   C += (1 - A) (sigma_s / sigma_t) alpha O L_a        emission: O = 1
///   A += (1 - A) alpha
///   O  = exp(-sigma_t d) * mean of O over the cone's footprint on the slice before   (Algorithm 3; 2 as in the paper)
/// and in the end C + (1 - A) L_b. O is read straight before a point along the slice normal. That is emission and dos.
/// By ordinates, with directions k of radiance L_k, lengths per depth c_k of their paths, and of the path to the eye r:
///   C += (1 - A) (sigma_s / sigma_t) (1 - exp(-tau (1 + a))) / (1 + a) L_a sum_k L_k T_k      tau = sigma_t d r
///   T_k = exp(-c_k tau_j / r) over all slabs j in front, along the path of k, met in whole texels of the lattice of
///   light
/// with a = c / r for the one c that would scatter the same from a solid slab: sum_k L_k T_k / (1 + c_k) = sum_k L_k
/// T_k / (1 + c). Between texels, sums are interpolated with the transmittance along the view axis as their weight.
/// Sources: Max 1995, doi:10.1109/2945.468400; Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x
class SliceRenderer {
 public:
  /// Culls, plans the atlas and compiles what the scene needs; bricks are uploaded by the first render().
  /// @param scene  resolved, see resolveScene; `volume` must have the apron and the gradients it needs and outlive this
  /// @throw InvalidArgument  an image beyond the driver's limit, a volume with a too narrow apron, a budget too small
  /// @throw GlError
  /// @pre `context` is current and outlives this
  SliceRenderer(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                const RenderOptions& options = {});
  ~SliceRenderer();

  /// One picture. Bricks that fit the budget stay for the next one.
  /// @throw GlError, InvalidArgument
  Picture render();
  /// The same scene from another camera of the same image size.
  /// @throw InvalidArgument  another size, or slabs that reach beyond the apron
  Picture render(const Camera& camera, const RenderSample& sample = {});

  /// What slice i (of those in the last picture) samples: channel 0 the interpolated value, grid units, at the middle
  /// of the slab, channel 1 how many bricks shade the pixel.
  /// @throw InvalidArgument  no such slice
  Image probe(std::int64_t slice);
  /// Depths of the slices of the last picture, world units.
  std::vector<double> sliceDepths() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace umbrick
