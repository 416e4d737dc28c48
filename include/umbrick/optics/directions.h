// Sets of directions that stand for a solid angle.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <vector>

namespace umbrick {

struct WeightedDirection {
  glm::dvec3 direction;  // unit length
  double weight = 0;     // share of the solid angle; those of a set sum to 1
};

/// About `count` directions of the cone of half-angle `aperture` around `axis`: rings at the Gauss-Legendre nodes in
/// cos(angle), each with directions at equal steps of azimuth, as many as its circumference asks for, rings staggered
/// by the golden angle. Exact for polynomials in cos(angle) of degree 2 rings - 1.
/// @param rotation  azimuth of the first direction, rad: rotated sets average to finer ones
/// @return one direction for aperture 0 or count 1 (then the axis)
/// @throw InvalidArgument  axis of no length, aperture outside [0, pi], count < 1
std::vector<WeightedDirection> coneDirections(const glm::dvec3& axis, double aperture, int count, double rotation = 0);

/// Exactly `count` directions of the cone, each of the same weight: cosines at equal steps, azimuths at steps of the
/// golden angle (Swinbank and Purser 2006, Fibonacci grids). Few directions stand better for light with hard shadows
/// this way than in rings, whose azimuths are few: over points of a scene of hard occluders, RMS of V at 60 and 80
/// degrees with 16 directions 0.044 and 0.046 against 0.046 and 0.052, with 32 directions 0.028 and 0.030 against 0.039
/// and 0.035.
/// @throw InvalidArgument  as coneDirections
std::vector<WeightedDirection> spiralDirections(const glm::dvec3& axis, double aperture, int count,
                                                double rotation = 0);

/// As many for the whole sphere; no direction stands out.
std::vector<WeightedDirection> sphereDirections(int count, double rotation = 0);

/// A direction uniform in the solid angle of the cone. @param u,v  in [0, 1)
glm::dvec3 sampleCone(const glm::dvec3& axis, double aperture, double u, double v);

/// Nodes and weights of Gauss-Legendre quadrature over [0, 1]; the weights sum to 1. @throw InvalidArgument  count < 1
struct QuadratureNode {
  double position = 0, weight = 0;
};
std::vector<QuadratureNode> gaussLegendre(int count);

}  // namespace umbrick
