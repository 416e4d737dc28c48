// The light sources of a scene, for the model `lights`.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <variant>
#include <vector>

#include "umbrick/core/names.h"
#include "umbrick/image/image.h"

namespace umbrick {

/// The frame in which a source's directions are given. view: right, up and towards the viewer, so that the light moves
/// with the camera; world: the world's axes. All directions point towards the light and may have any length.
enum class LightFrame { view, world };
inline constexpr Name<LightFrame> kLightFrames[]{{"view", LightFrame::view}, {"world", LightFrame::world}};

/// A light with the same radiance from every direction of a cone: a tilted cone or, where it is narrow, a distant
/// light with soft shadows. A point of albedo 1 scatters L_a * radiance * the mean of T over the solid angle,
/// whatever the angle is: radiance 1 around the view axis is the model `cone`. In JSON "directional" is another name
/// for the same light.
struct ConeLight {
  glm::dvec3 axis{0, 0, 1};
  double aperture = 0;     // theta: half-angle, rad, in [0, pi/2); 0: one direction, hard shadows
  glm::dvec3 radiance{1};  // linear RGB
  bool operator==(const ConeLight&) const = default;
};

/// A direction that is taken as it is. A list of them gives L_a * the sum of weight * colour * T.
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

/// A light that is an environment map: all of it where light may come from behind (lightComesFromBehind() of
/// capabilities.h), else the half in front of the viewer's plane, so that a map of constant radiance 1 is as bright as
/// a cone of radiance 1/2. A point scatters L_a * scale / (4 pi) * the integral of the map's radiance times T, as an
/// isotropic phase function does.
///
/// The map is a latitude-longitude one as OpenEXR defines it, seen from its centre: its upper row is at `up`, the
/// middle of the picture at `front`, and columns to the right of that at front x up. By default the middle of the map
/// is behind the viewer, so that it lights what the viewer sees, and pixels to the right of it light from the viewer's
/// left. Radiance is constant over a pixel.
struct EnvironmentLight {
  std::filesystem::path file;          // name of the file in a scene file
  std::shared_ptr<const Image> image;  // 1, 3 or 4 channels, the fourth does not count; finite and not negative
  glm::dvec3 up{0, 1, 0};              // upper end of the map, in the frame of the source
  glm::dvec3 front{0, 0, 1};           // towards the middle of the map; only its part perpendicular to `up` counts
  double scale = 1;                    // 0 or more
  /// Compares names and pixels.
  bool operator==(const EnvironmentLight& other) const;
};
/// Reads the main layer of an EXR file.
/// @throw IoError  as readExr; the layer has other channels than R, G, B or Y, or a pixel that is negative or not
///   finite: the message names the file and the pixel
EnvironmentLight loadEnvironment(const std::filesystem::path& file);

struct LightSource {
  LightFrame frame = LightFrame::view;
  std::variant<ConeLight, ListedLight, EnvironmentLight> light;
  bool operator==(const LightSource&) const = default;
};

}  // namespace umbrick
