// Sets of directions that stand for a solid angle.
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
