// A picture that gets better pass by pass, and says how far off it still is.
#pragma once
#include <cstdint>
#include <functional>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/context.h"
#include "umbrick/scene/scene.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

/// How far a picture is from what it would be with all directions and infinitely thin slabs: RMS over pixels of linear
/// premultiplied RGB.
struct ErrorEstimate {
  /// Standard error of the mean of the passes so far: of directions, of where slices lie and of how paths are rounded.
  /// From the spread of kStreams means; infinite before there are as many.
  double statistical = 0;
  /// What does not average out: of thickness of slabs and texels of windows. Pictures with both twice as large are off
  /// by about twice as much (first order, see the convergence tests): the difference to them. An estimate: where texels
  /// are much larger than slabs the true one has been seen to be twice that. Infinite before it is known, or when
  /// slabs twice as thick reach beyond the bricks' apron.
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
  Picture picture;  // mean of the passes; stats of the last one
  int passes = 0;
  double seconds = 0;
  ErrorEstimate error;
  Scene scene;  // that the passes are of: the one given, or a finer one, whose windows have an explicit scale
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
/// @param volume  bricks with the apron of coarserScene(scene), or without an estimate of the systematic error
/// @param onPass  called after every pass with the picture so far; false stops
/// @throw InvalidArgument  a model or a method without directions; an option out of range; as SliceRenderer
ProgressivePicture renderProgressive(const GlContext& context, const Bricks& volume, const Scene& scene,
                                     const ProgressiveOptions& options, const RenderOptions& render = {},
                                     const std::function<bool(const ProgressivePicture&)>& onPass = {});

/// The scene with slabs and window texels twice as large, by which the systematic error is estimated; texels that the
/// renderer chooses (scale 0) are doubled when it has chosen.
Scene coarserScene(const Scene& scene);

}  // namespace umbrick
