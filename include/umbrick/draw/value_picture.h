// What all techniques share of the modes that show values: how numbers become a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "umbrick/core/camera.h"
#include "umbrick/core/range.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Tells whether a mode looks at values. All but hybrid look at no medium then.
bool showsValues(Mode mode);

/// Bricks need an apron of this for surfaces, and for a medium that reflects light: gradients look one voxel beyond a
/// cell's corners, by whichever filter.
inline constexpr int kGradientApron = 2;

/// Returns the apron that the surfaces of a scene need, which is more where light reaches them.
int surfaceApron(const SceneSettings& scene);

/// Checks what a scene's surfaces ask of a volume.
/// @param values  of all voxels, the background included; @param apron  of its bricks
/// @throw InvalidArgument  there is no surface, or one of a value that the volume does not have; the apron is too small
void checkSurfaces(const ResolvedScene& scene, const Range& values, int apron);

/// Checks whether the light that reaches surfaces can be computed, see umbrick/scene/surface_light.h.
/// @throw InvalidArgument  it cannot: the model or the method is none of light volumes
void checkSurfaceLight(const ResolvedScene& scene);

/// Checks what a medium that reflects light asks for. @param apron  of bricks
/// @throw InvalidArgument  as shadingLights; the apron is too small
void checkShading(const ResolvedScene& scene, int apron);

/// Returns the scene whose medium a mode sees. To an X-ray all else than the light that gets through does not matter,
/// which is asked for to the last bit; of hybrid it is mediumBehind(). Scenes of other modes are returned as they are.
ResolvedScene mediumOf(const ResolvedScene& scene);
/// Makes an X-ray of a picture of that medium. The share that gets through is its layer "value".
void showThrough(const ResolvedScene& scene, Picture& picture);

/// Stores a pixel over the scene's background. @param out  RGBA
void storeOver(const ResolvedScene& scene, const glm::dvec4& premultiplied, float* out);
/// Colours a projected value; that of empty space is not shown. @param out  RGBA
void storeProjected(const ResolvedScene& scene, double value, double background, float* out);

/// The ray of a pixel in the world. A point of it is from + depth along, where the depth is that along the view axis.
struct WorldRay {
  glm::dvec3 from, along;
  glm::dvec3 viewer;  // direction towards the eye, unit length
};
/// @param screen  see IndexView
WorldRay worldRay(const Camera& camera, const CameraFrame& frame, const glm::dvec2& screen);

/// What is known of the nearest surface of each pixel; NaN where there is none.
class SurfaceLayers {
 public:
  SurfaceLayers(int width, int height);
  void keep(int x, int y, double value, const glm::dvec3& position, const glm::dvec3& normal);
  void moveTo(Picture& picture);

 private:
  Image value_, position_, normal_;
};

}  // namespace umbrick
