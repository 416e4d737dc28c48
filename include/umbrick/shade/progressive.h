// A picture that gets better pass by pass, and says how far off it still is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/context.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

/// How far a picture is from what it would be with all directions and infinitely thin slabs: RMS over pixels of linear
/// premultiplied RGB.
struct ErrorEstimate {
  /// Standard error of the mean of the passes so far: of directions, of where slices lie and of how paths are rounded.
  /// From the spread of kStreams means; infinite before there are as many.
  double statistical = 0;
  /// What does not average out: of thickness of slabs, length of their segments and texels of windows. From the
  /// difference of pictures of the first kStreams passes to such with all three twice as large, less what it has by
  /// chance. Where errors fall with the order p that is 2^p - 1 times the error. p is 1 at most, and at hard edges that
  /// cast shadows has been seen as low as 0.45 where texels are 2 voxels or more, higher below; so it is multiplied by
  /// the geometric mean of 1 / (2^p - 1) at both: 1.65 for `draft` and `normal`, 1.34 for `high`. Measured on six
  /// volumes at 30, 60 and 80 degrees with solid and translucent media, 128 x 128 and 256 x 256 pixels, 8 passes, over
  /// the true error: `normal` 0.53 to 1.85 (27 pictures), `draft` 0.62 to 1.63 (21), `high` 1.18 to 1.78 (11).
  /// Lowest where solid surfaces are seen at a grazing angle under wide light: they are too dark by almost as much with
  /// slabs of 2.5 voxels as with 10. Of volumes that are few slabs deep it tells little, since errors then follow no
  /// order: from a sixth of the true error to 2.6 times of it, in volumes of four to eight slabs.
  /// Infinite before kStreams passes.
  double systematic = 0;
  double total() const;  // root of the sum of squares
};

struct ProgressiveOptions {
  int passes = 64;         // at most, 1 or more
  double maxSeconds = 0;   // no pass begins after so many; 0: any time
  double targetError = 0;  // stop when the estimated total error is no more than this; 0: never
  bool refine = false;     // begin again with slabs and texels half as large where the systematic error alone is in
                           // the way of the target, down to an eighth of a voxel, and kStreams passes are left
  std::uint64_t seed = 1;  // other seeds, other pictures of the same expectation
};

struct ProgressivePicture {
  Picture picture = {};  // mean of the passes; stats of the last one
  int passes = 0;
  double seconds = 0;
  ErrorEstimate error = {};
  ResolvedScene scene;  // that the passes are of: the one given, or a finer one, whose windows have an explicit scale
  bool reachedTarget = false;
};

/// Streams of passes that know nothing of each other, whose spread tells the standard error. Pass i belongs to stream
/// i modulo this.
inline constexpr int kStreams = 4;

/// Renders cone or lights by ordinates again and again, each time with the next K directions of a low-discrepancy
/// sequence (lightSamples) and other places of slices, of the lattice of light and of roundings, and averages: the
/// picture is linear in its light. Passes of a stream continue one sequence, so that the error falls faster than with
/// the root of their number, and the streams' spread, which needs no more than that they are independent, is an honest
/// standard error (replicated quasi-Monte Carlo, Owen 1997). The same seed gives the same picture.
/// All pictures read the same resident bricks.
/// @param volume  bricks with the apron of coarserScene(scene); with less, where slabs twice as thick reach beyond it,
/// the systematic error comes from the difference to slabs half as thick, at eight times the cost of the first passes
/// @param onPass  called after every pass with the picture so far; false stops
/// @throw InvalidArgument  a model or a method without directions; an option out of range; as SliceRenderer
ProgressivePicture renderProgressive(ResidentVolume& volume, const ResolvedScene& scene,
                                     const ProgressiveOptions& options, const RenderOptions& render = {},
                                     const std::function<bool(const ProgressivePicture&)>& onPass = {});
/// The same, of a volume that is made resident for it.
ProgressivePicture renderProgressive(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                                     const ProgressiveOptions& options, const RenderOptions& render = {},
                                     const std::function<bool(const ProgressivePicture&)>& onPass = {});

/// The scene with slabs, their segments and window texels twice as large, by which the systematic error is estimated;
/// texels that the renderer chooses (scale 0) are doubled when it has chosen.
ResolvedScene coarserScene(const ResolvedScene& scene);

}  // namespace umbrick
