// Sets of directions that stand for a solid angle.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <vector>

namespace umbrick {

struct WeightedDirection {
  glm::dvec3 direction;  // unit length
  double weight = 0;     // share of the solid angle; the weights of a set sum to 1
};

/// Returns about `count` directions of the cone of half-angle `aperture` around `axis`. They lie in rings at the
/// Gauss-Legendre nodes in cos(angle). Each ring has as many directions as its circumference asks for, at equal steps
/// of azimuth, and the golden angle lies between the starts of two rings. Sums are exact for polynomials in cos(angle)
/// of degree 2 rings - 1.
/// @param rotation  azimuth of the first direction, rad; pictures with rotated sets average to those of a finer set
/// @return the axis alone for aperture 0 or count 1
/// @throw InvalidArgument  axis of no length, aperture outside [0, pi], or count < 1
std::vector<WeightedDirection> coneDirections(const glm::dvec3& axis, double aperture, int count, double rotation = 0);

/// Returns exactly `count` directions of the cone, each of the same weight, with cosines at equal steps and azimuths at
/// steps of the golden angle (Swinbank and Purser 2006, Fibonacci grids). For light with hard shadows few directions do
/// better in this way than in rings, whose azimuths are few. Over points of a scene of hard occluders, the RMS of V at
/// 60 and 80 degrees with 16 directions is 0.044 and 0.046 against 0.046 and 0.052; with 32 directions it is 0.028 and
/// 0.030 against 0.039 and 0.035.
/// @throw InvalidArgument  as coneDirections
std::vector<WeightedDirection> spiralDirections(const glm::dvec3& axis, double aperture, int count,
                                                double rotation = 0);

/// Returns about `count` directions of the whole sphere in the same way, in rings around z. No direction is preferred.
std::vector<WeightedDirection> sphereDirections(int count, double rotation = 0);

/// Returns a direction that is uniform in the solid angle of the cone. @param u,v  in [0, 1)
glm::dvec3 sampleCone(const glm::dvec3& axis, double aperture, double u, double v);

/// A node of Gauss-Legendre quadrature over [0, 1].
struct QuadratureNode {
  double position = 0, weight = 0;
};
/// Returns `count` nodes, whose weights sum to 1. @throw InvalidArgument  count < 1
std::vector<QuadratureNode> gaussLegendre(int count);

}  // namespace umbrick
