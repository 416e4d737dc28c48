// The optical model integrated on the CPU, ray by ray: what every renderer is compared with.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/image/exr.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

enum class Integrator {
  quadrature,  // deterministic, double precision
  monteCarlo,  // unbiased, with an estimate of its own error
};
inline constexpr Name<Integrator> kIntegrators[]{{"quadrature", Integrator::quadrature},
                                                 {"monte-carlo", Integrator::monteCarlo}};

struct ReferenceOptions {
  Integrator integrator = Integrator::quadrature;
  // The following three are for the quadrature.
  double step = 0;  // step along the ray to the eye, in voxels (shortest edge); 0: adaptive steps
  /// Of adaptive steps: the error of the radiance of a stretch of the ray, relative to L_a.
  double tolerance = 1e-4;
  int directions = 256;  // about so many directions over the cone, the sphere or the lights
  // The following three are for Monte Carlo.
  /// Paths per pixel; if a standard error is asked for, the most paths that a pixel takes. With several samples a pixel
  /// each of them has as many paths: so many whole rounds are taken as this allows.
  int samples = 256;
  /// A pixel takes no more paths when its estimated standard error is below this; 0: every pixel takes all.
  double standardError = 0;
  std::uint64_t seed = 1;
  // The following are for both.
  /// Of the models cone and lights: exactly these directions, as a renderer takes them; empty: all that there are.
  std::vector<LightDirection> lights;
  /// Passes over transparent nodes of the tree. When false, every voxel is visited, to measure what skipping gives.
  bool skipEmpty = true;
  int threads = 0;  // 0: one for each core
  /// Called from one thread at a time with the share of pixels that are done, in [0, 1], also during long pixels. The
  /// job stops when it returns false.
  std::function<bool(double)> progress;
};

struct ReferenceStats {
  std::uint64_t eyeRays = 0, lightRays = 0;
  std::uint64_t cells = 0;            // voxel cells that rays integrated over
  std::uint64_t samples = 0;          // evaluations of V (quadrature) or tentative collisions (Monte Carlo)
  double fieldMs = 0;                 // time to prepare the visible blocks
  double integrateMs = 0;             // wall-clock time to integrate
  double share = 0;                   // share of the pixels that are done
  std::uint64_t nonFiniteVoxels = 0;  // active NaN or infinite voxels, which are read as background
  std::uint64_t blocks = 0;           // blocks of 8^3 cells that are not transparent
  /// Pixels that took all samples and did not reach the standard error that was asked for.
  std::uint64_t unconvergedPixels = 0;
};

struct ReferencePicture {
  Image colour;  // linear premultiplied RGBA, as in Picture
  /// 1 channel: V weighted by opacity. With lights V is their share by power, the mean of R, G and B.
  Image visibility;
  /// 1 channel: mean depth along the view axis, weighted by opacity; infinite where A is 0.
  Image depth;
  Image standardError;  // of colour, 4 channels: estimated by Monte Carlo; 0 with quadrature
  /// Of other modes than integrate: the layers of Picture by the same names.
  std::vector<ImageLayer> layers;
  ReferenceStats stats;
  bool complete = true;  // false: the job was stopped, and pixels that were not done are 0
};

/// Integrates the ray through each pixel's centre or, where the scene asks for more samples a pixel
/// (sampling.pixelSamples), the mean over rays through the places of pixelPoints, which are those that renderers take:
/// both have the same box filter. V and depth are averaged by opacity. With T the transmittance,
///   C = Int T sigma_s V L_a ds + T_end L_b      A = 1 - T_end (1 with a background)
///   V = mean over the model's directions of T from the point to where the medium ends, 1 for `emission`
/// and for `lights` the sum of radiance_k T_k takes the place of V, see LightDirection.
///
/// The medium is the trilinear interpolation of the voxels (for a 2D transfer function also of the gradient magnitudes
/// at voxels), classified afterwards. It lies inside the clip planes, the clip box and mediumBox (scene/resolve.h). The
/// faces of mediumBox are where a visible background ends; no other scene is cut by them. Nothing nearer than
/// nearDistance is seen or occludes. For `cone` and `lights` the same holds for what lies behind the eye, as in a sweep
/// that begins at the eye.
///
/// Quadrature: light comes from lightDirections. A ray meets voxel cells in order. In a cell the value along the ray is
/// a cubic, and a 1D function is linear between its points, so the optical depth over each piece is a polynomial that
/// is integrated exactly. V is evaluated at the centre of the scattering of each stretch of the ray. Stretches are
/// halved until that changes the radiance by less than the tolerance (of all light there is). They end where less than
/// a hundredth of the tolerance, at most 1e-6, gets through. A 2D function is cut where the ray crosses the lines of
/// its lattice; its extinction, of degree six in between, is taken for a cubic over each quarter of a cell or less.
///
/// Monte Carlo: each path takes delta tracking to one collision, with majorants per block of 8^3 cells (Woodcock et al.
/// 1965), and from there ratio tracking along one direction, of a light chosen by power (Novák et al. 2014,
/// doi:10.1145/2661229.2661292). The random numbers come from one stream per pixel, so the picture is the same for any
/// number of threads.
///
/// Other modes than integrate are rendered in double precision, too, whatever the integrator: projections and surfaces
/// from the cubic that the value is along a ray in each voxel cell, so that no maximum and no surface is missed.
///
/// Sources of the model: Max 1995, doi:10.1109/2945.468400; Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x
/// @param scene  resolved, see resolveScene
/// @throw InvalidArgument  an option out of range, a light that lightDirections refuses
ReferencePicture renderReference(const ScalarGrid& grid, const ResolvedScene& scene,
                                 const ReferenceOptions& options = {});

}  // namespace umbrick
