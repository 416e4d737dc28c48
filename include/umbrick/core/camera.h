// The camera: where it stands, what it sees, and how image points map to rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "umbrick/core/box.h"
#include "umbrick/core/names.h"

namespace umbrick {

enum class Projection { perspective, orthographic };
inline constexpr Name<Projection> kProjections[]{{"perspective", Projection::perspective},
                                                 {"orthographic", Projection::orthographic}};

struct Camera {
  glm::dvec3 eye{0, 0, 1};     // world space
  glm::dvec3 lookAt{0, 0, 0};  // world space
  glm::dvec3 up{0, 1, 0};      // any length, but not along the view direction
  Projection projection = Projection::perspective;
  double fov = 0.5235987755982988;  // perspective only: full vertical angle of view, rad, in (0, pi)
  double viewHeight = 1;            // orthographic only: height of the view, world units
  double nearDistance = 0;          // world units along the view direction; what is nearer than this is not seen
  int width = 512;                  // pixels
  int height = 512;                 // pixels
  bool operator==(const Camera&) const = default;
};

/// Orthonormal axes of the view in world space. Depth is measured along `forward`, from the eye.
struct CameraFrame {
  glm::dvec3 right, up, forward;
};

/// Computes the axes of the view. A mirrored world keeps its handedness.
/// @throw InvalidArgument  eye equals lookAt, up is parallel to the view direction, something is not finite,
///                         fov outside (0, pi), viewHeight <= 0, width or height < 1, or nearDistance < 0
CameraFrame cameraFrame(const Camera& camera);

/// The image plane. The world point of screen point p at depth s is
///   perspective   eye + s (forward + p.x right + p.y up)
///   orthographic  eye + s forward + p.x right + p.y up
/// Screen points are measured at depth 1 (perspective) or in world units (orthographic); the centre of the image is at
/// 0 and y points up.
struct ScreenPlane {
  glm::dvec2 halfExtent;  // the image covers [-halfExtent, halfExtent]
  glm::dvec2 pixelSize;   // size of one pixel, which is square
};
ScreenPlane screenPlane(const Camera& camera);

/// Returns a camera on a sphere around `bounds` that looks at its centre and sees all of it. At azimuth 0 and elevation
/// 0 it looks along +y from the front (-y) with z up, the usual view of a patient lying along z. Azimuth turns the eye
/// around +z (counter-clockwise from above), and elevation lifts it; at the poles up is continued.
/// @param azimuth,elevation  rad
/// @param base  gives projection, fov, image size and so on; eye, lookAt, up and viewHeight are replaced
/// @throw InvalidArgument  empty bounds, or a camera that cameraFrame refuses
Camera orbitCamera(const Box& bounds, double azimuth, double elevation, Camera base = {});

/// How to look at a thing from a sphere around it.
struct OrbitView {
  double azimuth = 0, elevation = 0;  // rad; at 0 and 0 the eye is where the thing faces
  glm::dvec3 up{0, 0, 1};             // a unit vector; azimuth turns the eye around it, counter-clockwise from above
  glm::dvec3 front{0, -1, 0};         // the way the thing faces, a unit vector at right angles to up
  double zoom = 1;                    // so many times larger; the perspective stays
  glm::dvec2 pan{0};                  // moves the thing to the right and up, in heights of the picture
};

/// Does the same for a thing that stands upright in another way, zoomed and moved.
/// @throw InvalidArgument  as above; up and front are no unit vectors at right angles; zoom <= 0; something is not
/// finite
Camera orbitCamera(const Box& bounds, const OrbitView& view, Camera base = {});

/// Returns how many times larger a box can be drawn until one of its corners comes within 4 % of the picture's border.
/// An orbit leaves room for a sphere around the box, so that a thing keeps its size while it turns; a picture of one
/// view need not. @throw InvalidArgument  the box is empty, or as cameraFrame
double fillingZoom(const Camera& camera, const Box& box);

}  // namespace umbrick
