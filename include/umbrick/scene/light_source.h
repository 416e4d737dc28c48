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

/// What a source's directions are given in. view: right, up and towards the viewer, so that the light moves with the
/// camera; world: the world's axes. All directions point towards the light and may have any length.
enum class LightFrame { view, world };
inline constexpr Name<LightFrame> kLightFrames[]{{"view", LightFrame::view}, {"world", LightFrame::world}};

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

/// The half of an environment map that is in front of the viewer's plane: L_a * scale / (4 pi) * the integral over it
/// of the map's radiance times T, the light that an isotropic phase function scatters. The rest of the map is left out,
/// so a map of constant radiance 1 is as bright as a cone of radiance 1/2.
///
/// The map is a latitude-longitude one as OpenEXR has it, seen from its centre: upper row at `up`, middle of the
/// picture at `front`, columns to the right of it at front x up. Its defaults have the middle of the map behind the
/// viewer, who is lit from there; pixels to the right light the viewer's left. Radiance is constant over a pixel.
struct EnvironmentLight {
  std::filesystem::path file;          // what a scene file calls it
  std::shared_ptr<const Image> image;  // 1, 3 or 4 channels, the fourth does not count; finite and not negative
  glm::dvec3 up{0, 1, 0};              // of the map, in the frame of the source
  glm::dvec3 front{0, 0, 1};           // direction of the middle of the map, or rather its part that is across `up`
  double scale = 1;                    // 0 or more
  /// By name and by pixels.
  bool operator==(const EnvironmentLight& other) const;
};
/// Reads the main layer of an EXR file. @throw IoError  as readExr; other channels than R, G, B or Y, a pixel that is
/// negative or not finite: names the file and the pixel
EnvironmentLight loadEnvironment(const std::filesystem::path& file);

struct LightSource {
  LightFrame frame = LightFrame::view;
  std::variant<ConeLight, ListedLight, EnvironmentLight> light;
  bool operator==(const LightSource&) const = default;
};

}  // namespace umbrick
