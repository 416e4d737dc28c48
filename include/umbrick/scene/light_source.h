// The light sources of a scene, for the model `lights`.
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <variant>
#include <vector>

namespace umbrick {

/// What a source's directions are given in. view: right, up and towards the viewer, so that the light moves with the
/// camera; world: the world's axes. All directions point towards the light and may have any length.
enum class LightFrame { view, world };

/// The same radiance from every direction of a cone: a tilted cone, or, narrow, a distant light with soft shadows. A
/// point of albedo 1 scatters L_a * radiance * the mean of T over the solid angle, whatever the angle is: radiance 1
/// around the view axis is the model `cone`. In JSON also called "directional", which is the same.
struct ConeLight {
  glm::dvec3 axis{0, 0, 1};
  double aperture = 0;     // theta: half-angle, rad, in [0, pi/2); 0: one direction, hard shadows
  glm::dvec3 radiance{1};  // linear RGB
  bool operator==(const ConeLight&) const = default;
};

/// Directions taken as they are: L_a * the sum of weight * colour * T.
struct ListedDirection {
  glm::dvec3 direction{0, 0, 1};
  double weight = 1;
  glm::dvec3 colour{1};  // linear RGB
  bool operator==(const ListedDirection&) const = default;
};
struct ListedLight {
  std::vector<ListedDirection> list;
  bool operator==(const ListedLight&) const = default;
};

struct LightSource {
  LightFrame frame = LightFrame::view;
  std::variant<ConeLight, ListedLight> light;
  bool operator==(const LightSource&) const = default;
};

}  // namespace umbrick
