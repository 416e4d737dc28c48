// Tables of what follows from a model and a method, so that code asks these and compares no names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "umbrick/scene/scene.h"

namespace umbrick {

/// What is true of the light of a model.
struct ModelTraits {
  Model model;
  std::string_view meaning;  // for help: "whole sphere"
  bool occlusion = false;    // the medium dims light on its way to a point
  bool cone = false;         // light comes from a cone of half-angle theta
  bool aroundRay = false;    // that cone is around the ray to the eye, not around the view axis
  bool sphere = false;       // light comes from the whole sphere
  bool directions = false;   // light is a set of directions, see lightDirections
  bool sources = false;      // light comes from the scene's light sources
  bool behindEye = false;    // what lies behind the eye occludes, too
};
std::span<const ModelTraits> modelTraits();
const ModelTraits& traitsOf(Model model);

/// What a method of occlusion can do.
struct MethodTraits {
  Method method;
  std::string_view meaning;
  bool sources = false;     // any sources in front of the viewer; else one cone around the view axis
  bool directions = false;  // light is a set of directions, so that pictures of other sets can be averaged
  bool allAround = false;   // light may come from everywhere, not from the viewer's side alone
};
const MethodTraits& traitsOf(Method method);

/// Returns the method that computes a scene's occlusion; none where the scene's model has no occlusion.
std::optional<Method> occlusionMethod(const SceneSettings& scene);

/// Refuses a scene whose occlusion is found by rays from each sample, which only rays do, in media.
/// @param other  what does not: "slices"
/// @throw InvalidArgument
void refuseConeRays(const SceneSettings& scene, std::string_view other);
/// Refuses such a scene where it has what rays do not light so: surfaces, shading, light of a second grid.
/// @throw InvalidArgument
void checkConeRays(const SceneSettings& scene);

/// Refuses a scene that interpolates media where its model has occlusion, or where it emits: both know values alone.
/// @throw InvalidArgument
void requireClassification(const SceneSettings& scene);

/// Tells whether the method can compute the light of the model.
bool supports(Method method, Model model);

/// What is true of a mode.
struct ModeTraits {
  Mode mode;
  std::string_view meaning;  // for help: "the largest value along each ray"
  bool projection = false;   // a number a ray, which is the picture's layer "value"
  bool ofValues = false;     // that number is a value of the grid
  bool surfaces = false;     // the scene's surfaces are seen
  bool medium = false;       // a medium is seen
};
std::span<const ModeTraits> modeTraits();
const ModeTraits& traitsOf(Mode mode);

/// Tells whether a technique renders pictures of a mode anywhere. @pre not Technique::automatic
bool supports(Technique technique, Mode mode);
/// Tells whether a technique renders the scene's mode with its shading, and its mesh where it has one.
bool supportsMode(const SceneSettings& scene, Technique technique);
/// @throw InvalidArgument  the technique does not render the scene's mode, and which do; or the mode cannot be shaded
void requireMode(const SceneSettings& scene, Technique technique);

/// Tells whether a picture of the scene shows light that a second grid of its volume emits: only modes that show a
/// medium and its colours do.
bool emits(const SceneSettings& scene);
/// Tells whether what is emitted lights the medium around it, too. Only light volumes and the reference compute that.
bool emissionLights(const SceneSettings& scene);
/// Returns what renderers multiply the light in the medium by: L_a, but 1 where a light volume also holds light that is
/// emitted, to which L_a is nothing. It holds L_a then (see lightInMedium()).
glm::dvec3 lightScale(const SceneSettings& scene);

/// Tells whether a picture of the scene reflects light.
bool isShaded(const SceneSettings& scene);
/// Tells whether the scene's mesh does.
bool isMeshShaded(const SceneSettings& scene);

/// Tells whether light may come from behind what the viewer sees. Then what lies behind the eye occludes, too, and
/// environments light as a whole; else lights have to be in front of the viewer, and the front half of environments
/// counts.
bool lightComesFromBehind(const SceneSettings& scene);

}  // namespace umbrick
