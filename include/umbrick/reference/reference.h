// The optical model integrated on the CPU, ray by ray: what every renderer is compared with.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/image/image.h"
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
  // Quadrature
  double step = 0;          // along the ray to the eye, in voxels (shortest edge); 0: adaptive
  double tolerance = 1e-4;  // adaptive: of the radiance of a stretch of the ray, relative to L_a
  int directions = 256;     // about so many over the cone, the sphere or the lights
  // Monte Carlo
  int samples = 256;         // paths per pixel; with standardError the most a pixel takes
  double standardError = 0;  // stop a pixel when its estimated standard error is below this; 0: all samples
  std::uint64_t seed = 1;
  // Both
  std::vector<LightDirection> lights;  // for cone and lights: exactly these, as a renderer takes them; empty: all
  bool skipEmpty = true;  // pass over transparent nodes of the tree; false: visit every voxel, to measure what it gives
  int threads = 0;        // 0: all cores
  /// Called from one thread at a time with the share of pixels done, in [0, 1], also during long pixels; false stops.
  std::function<bool(double)> progress;
};

struct ReferenceStats {
  std::uint64_t eyeRays = 0, lightRays = 0;
  std::uint64_t cells = 0;              // voxel cells that rays integrated over
  std::uint64_t samples = 0;            // evaluations of V (quadrature), tentative collisions (Monte Carlo)
  double fieldMs = 0;                   // preparing the visible blocks
  double integrateMs = 0;               // wall clock
  double share = 0;                     // of the pixels that are done
  std::uint64_t nonFiniteVoxels = 0;    // active NaN or infinite voxels, read as background
  std::uint64_t blocks = 0;             // of 8^3 cells that are not transparent
  std::uint64_t unconvergedPixels = 0;  // that took all samples and did not reach the standard error asked for
};

struct ReferencePicture {
  Image colour;         // linear premultiplied RGBA, as Picture
  Image visibility;     // 1 channel: V weighted by opacity; with lights their share by power, the mean of R, G and B
  Image depth;          // 1 channel: mean depth along the view axis weighted by opacity; infinite where A is 0
  Image standardError;  // 4 channels, of colour: estimated by Monte Carlo, 0 with quadrature
  ReferenceStats stats;
  bool complete = true;  // false: stopped; pixels that were not done are 0
};

/// Integrates, for the ray through each pixel's centre, with T the transmittance,
///   C = Int T sigma_s V L_a ds + T_end L_b      A = 1 - T_end (1 with a background)
///   V = mean over the model's directions of T from the point to where the medium ends, 1 for `emission`
/// and for `lights` with the sum of radiance_k T_k in place of V, see LightDirection.
/// The medium is the trilinear interpolation of the voxels (and of the gradient magnitudes at voxels, for a 2D transfer
/// function), classified afterwards, inside the clip planes, the clip box and mediumBox (scene/resolve.h), whose faces
/// are where a visible background ends; no other scene is cut by them. Nothing nearer than nearDistance is seen or
/// occludes; for `cone` and `lights`, as in a sweep that begins at the eye, neither is what lies behind the eye.
///
/// Quadrature: light comes from lightDirections. A ray meets voxel cells in order. In a cell the value along the ray is
/// a cubic; a 1D function is linear between its points, so the optical depth over each piece is a polynomial that is
/// integrated exactly. V is evaluated at the centre of the scattering of each stretch of the ray; stretches are halved
/// until that changes the radiance by less than the tolerance (of all light there is), and end where less than a
/// hundredth of it, at most 1e-6, gets through. A 2D function is cut where the ray crosses the lines of its lattice;
/// its extinction, of degree six in between, is taken for a cubic over each quarter of a cell or less. Monte Carlo:
/// delta tracking to one collision per path with majorants per block of 8^3 cells (Woodcock et al. 1965), ratio
/// tracking along one direction from there, of a light chosen by power (Novák et al. 2014,
/// doi:10.1145/2661229.2661292). Numbers come from one stream per pixel: the picture is the same for any number of
/// threads.
///
/// Sources of the model: Max 1995, doi:10.1109/2945.468400; Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x
/// @param scene  resolved, see resolveScene
/// @throw InvalidArgument  an option out of range, a light that lightDirections refuses
ReferencePicture renderReference(const ScalarGrid& grid, const ResolvedScene& scene,
                                 const ReferenceOptions& options = {});

}  // namespace umbrick
