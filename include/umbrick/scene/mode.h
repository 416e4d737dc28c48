// What a picture shows of a volume, and how surfaces in it are shaded.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "umbrick/core/names.h"

namespace umbrick {

/// What a picture shows along each ray. `integrate` is a medium that emits, scatters and absorbs. The next three are
/// projections of the value: its maximum, its minimum or its mean over the ray's way through the box of the volume's
/// voxel centres, as far as clip planes leave it. `xray` is the share of light that gets through the medium,
/// exp(-integral of sigma_t). `isosurface` is where the value crosses those of the scene's surfaces. `hybrid` is the
/// first of these surfaces that a ray meets, and the medium behind it with what the surface lets through: what lies in
/// front of the surface, and what is seen past it, is not shown. So the eye looks through a wall into what is behind.
/// Source: Scharsach, Hadwiger, Neubauer, Wolfsberger and Buehler 2006, doi:10.2312/VisSym/EuroVis06/315-322
enum class Mode { integrate, mip, minip, average, xray, isosurface, hybrid };
inline constexpr Name<Mode> kModes[]{{"integrate", Mode::integrate}, {"mip", Mode::mip},
                                     {"minip", Mode::minip},         {"average", Mode::average},
                                     {"xray", Mode::xray},           {"isosurface", Mode::isosurface},
                                     {"hybrid", Mode::hybrid}};
inline std::string modeName(Mode mode) { return std::string(nameOf(kModes, mode)); }

/// A surface on which the volume has one value. It is seen from both sides.
struct SceneSurface {
  double value = 0;  // grid units
  std::optional<glm::dvec3> colour =
      {};              // linear RGB in [0, 1]; none: the albedo of the transfer function at the value
  double opacity = 1;  // in [0, 1]
  bool operator==(const SceneSurface&) const = default;
};
inline constexpr int kMostSurfaces = 16;

/// How light is reflected. Automatic: surfaces by Phong, media not at all.
enum class Shading { automatic, none, phong };
inline constexpr Name<Shading> kShadings[]{
    {"auto", Shading::automatic}, {"none", Shading::none}, {"phong", Shading::phong}};

/// Where the light comes from that is reflected: from the eye, or from the scene's light sources. Automatic: from the
/// sources of the model `lights`, else from the eye.
enum class ShadingLight { automatic, headlight, sources };
inline constexpr Name<ShadingLight> kShadingLights[]{
    {"auto", ShadingLight::automatic}, {"headlight", ShadingLight::headlight}, {"sources", ShadingLight::sources}};

/// Phong's model: colour (ambient + diffuse N.L radiance) + specular (R.V)^shininess radiance, summed over the lights;
/// what of them arrives under models with occlusion is in umbrick/scene/surface_light.h.
/// Source: Phong 1975, doi:10.1145/360825.360839
struct ShadingOptions {
  Shading kind = Shading::automatic;
  ShadingLight light = ShadingLight::automatic;
  double ambient = 0.2, diffuse = 0.8, specular = 0.3, shininess = 20;
  bool operator==(const ShadingOptions&) const = default;
};

}  // namespace umbrick
