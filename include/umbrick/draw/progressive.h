// A picture that gets better sample by sample, and says how far off it still is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "umbrick/draw/renderer.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// An estimate of how far a picture is from what it would be with all directions and infinitely thin slabs: RMS over
/// pixels of linear premultiplied RGB.
struct ErrorEstimate {
  /// The standard error of the mean of the samples so far. It comes from the choice of directions, from where slices
  /// lie and from how paths are rounded. It is estimated from the spread of kStreams means, and infinite before there
  /// are as many. Where each sample sees pixels through another place, it is the error of their mean over the area,
  /// too.
  double statistical = 0;
  /// The error that does not average out. It comes from the distance between samples along a ray (of slices: the
  /// thickness of slabs, the length of their segments and the texels of windows). It is estimated from how much
  /// pictures of the first kStreams samples differ from those with all of these larger or smaller by one factor, less
  /// the difference that they have by chance. Where errors fall with the order p, the difference to a picture twice as
  /// coarse is 2^p - 1 times the error. A technique knows between which orders its errors fall
  /// (RaySampling::leastOrder, mostOrder), so the difference is multiplied by the geometric mean of what both tell.
  /// How far the estimate is from the true error is measured in tools/benchmark/README.md. It is lowest where solid
  /// surfaces are seen at a grazing angle under wide light: they are too dark by almost as much with slabs of 2.5
  /// voxels as with 10. For volumes that are few slabs deep the estimate tells little, since errors then follow no
  /// order: it was from a sixth of the true error to 2.6 times of it, in volumes of four to eight slabs. Of light
  /// volumes, what the spacing of voxels does to light is found in the same way, from pictures with light at every
  /// second voxel. The estimate is infinite before kStreams samples.
  double systematic = 0;
  double total() const;  // root of the sum of squares
};

struct ProgressiveOptions {
  int passes = 64;         // number of samples at most, 1 or more
  double maxSeconds = 0;   // no sample begins after so many; 0: any time
  double targetError = 0;  // stop when the estimated total error is no more than this; 0: never
  bool refine = false;     // begin again with samples half as far apart, see renderProgressive
  std::uint64_t seed = 1;  // other seeds give other pictures of the same expectation
  /// Sees pixels through another place in each sample, so that the picture converges to the mean over their area,
  /// whatever the scene's pixelSamples; else all samples go through the centres of pixels.
  bool pixelArea = true;
};

struct ProgressivePicture {
  Picture picture = {};  // mean of the samples; stats of the last one
  int passes = 0;
  double seconds = 0;
  ErrorEstimate error = {};
  ResolvedScene scene;  // of the samples: the one given, or a finer one, whose windows have an explicit scale
  bool reachedTarget = false;
};

/// Tells whether pictures of a scene can be averaged: unlit ones, and those whose light is a set of directions.
bool canAverage(const SceneSettings& scene);

/// The samples are dealt to so many streams that know nothing of each other. Their spread tells the standard error.
/// Sample i belongs to stream i modulo this number.
inline constexpr int kStreams = 4;

/// Renders the renderer's scene again and again and averages the samples, which it may since a picture is linear in its
/// light. Each sample has the next K directions of a low-discrepancy sequence (lightSamples) and, unless pixelArea is
/// false, another place inside the pixels; slices, the lattice of their light and its roundings lie elsewhere, too.
/// Samples of a stream continue one sequence, so that the error falls faster than with the root of their number, and
/// the streams' spread, which needs no more than that they are independent, is an honest standard error (replicated
/// quasi-Monte Carlo, Owen 1997). The same seed gives the same picture.
///
/// With ProgressiveOptions::refine the series begins again with samples half as far apart (slabs and texels half as
/// large), down to an eighth of a voxel, where the systematic error alone is in the way of the target and kStreams
/// samples are left.
/// @param renderer  of any technique; it has the same scene again when this returns. Where its bricks are not cut for
///   coarserScene(), see Renderer::sampling(), the systematic error comes from the difference to a finer scene, at a
///   higher cost of the first samples.
/// @param onPass  called after every sample with the picture so far; false stops
/// @throw InvalidArgument  a method without directions; an option out of range; as
///   Renderer
ProgressivePicture renderProgressive(Renderer& renderer, const ProgressiveOptions& options,
                                     const std::function<bool(const ProgressivePicture&)>& onPass = {});

/// Returns the scene with slabs, their segments and window texels twice as large, by which the systematic error is
/// estimated. Texels that the renderer chooses (scale 0) are doubled when it has chosen.
ResolvedScene coarserScene(const ResolvedScene& scene);

}  // namespace umbrick
