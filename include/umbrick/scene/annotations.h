// What annotations of a picture say, computed from its scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/image/annotate.h"
#include "umbrick/image/display.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Units of a volume as they are printed; empty where they are not known.
struct VolumeUnits {
  std::string length;  // of the world: "mm"
  std::string value;   // of the grid: "HU"
  std::string space;   // where the axes of the world point to in a patient: "LPS"
};

/// Returns the axes x, y and z of the world as the camera sees their directions: parallel, also under perspective.
/// @param space  three letters out of L or R, A or P, S or I, each for the end of an axis: then the arms have these
///   letters in place of x, y and z
std::vector<TriadAxis> worldTriad(const Camera& camera, const std::string& space = {});

/// Returns how many pixels a world unit takes across the view, in the plane through the point that is looked at.
double pixelsPerUnit(const Camera& camera);

/// Returns the largest length of 1, 2 or 5 times a power of ten that is no longer than `longest`.
/// @pre longest > 0 and finite
double roundLength(double longest);

/// Returns a bar of a round length, at most a quarter of the picture wide. Under perspective it holds in the plane
/// through the point that is looked at, and says so: "at the centre".
ScaleBar scaleBar(const Camera& camera, const std::string& lengthUnit);

/// Returns the colours of a transfer function from its first to its last control point, as a display shows the radiance
/// of a solid of that medium in the ambient light, unoccluded; opacities are extinctions over the largest one. Of a 2D
/// function it shows, for each value, the medium at the gradient where it is densest.
ColourBar colourBar(const ResolvedScene& scene, const std::string& valueUnit, const Look& look);

enum class Annotation { triad, scale, colours };
inline constexpr Name<Annotation> kAnnotations[]{
    {"triad", Annotation::triad}, {"scale", Annotation::scale}, {"colours", Annotation::colours}};

/// Returns the annotations that are asked for.
Annotations annotationsOf(const ResolvedScene& scene, const std::vector<Annotation>& wanted, const VolumeUnits& units,
                          const Look& look);

}  // namespace umbrick
