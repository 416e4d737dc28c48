// What helps to read a picture, drawn into it: an orientation triad, a scale bar and a colour bar.
//
// All of it is in terms of the image. What follows from a scene is computed by scene/annotations.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/image/image.h"

namespace umbrick {

/// An arm of the triad: an axis of length 1 as it is seen.
struct TriadAxis {
  glm::dvec2 end{0};     // to the right and up
  double depth = 0;      // of its end, along the view axis: below 0 it points towards the eye
  std::string label;     // at its end: "x", or a letter of the patient
  std::string opposite;  // at the other end; empty: nothing is drawn there
  glm::dvec3 colour{1};  // linear
};

struct ScaleBar {
  double pixels = 0;  // its length
  std::string label;  // "20 mm"
};

/// A strip of colours from the lowest value, below, to the highest one, above, and beside it how opaque each is.
struct ColourBar {
  std::vector<glm::dvec3> colours;  // linear display colours, evenly spaced
  std::vector<double> opacities;    // as many, in [0, 1]
  std::string low, high;            // labels of the ends
};

struct Annotations {
  std::vector<TriadAxis> triad;  // empty: none
  std::optional<ScaleBar> scale;
  std::optional<ColourBar> colours;
  bool empty() const { return triad.empty() && !scale && !colours; }
};

/// Returns the height of the annotations' font for a picture of this size, pixels: a fortieth of the shorter edge, and
/// no less than can be read.
double annotationEm(int width, int height);

/// Draws annotations over a picture: the triad in the lower left corner, the scale bar in the lower right one, the
/// colour bar at the right edge. Lines and letters have a rim, light ones a dark one and dark ones, over what is light,
/// a light one, so that they stand out from any background.
/// @param picture  4 channels, linear display values, premultiplied, see displayed()
/// @return what did not fit into the picture and is left out: "triad", "scale", "colours"
/// @throw InvalidArgument  not 4 channels; as many opacities as colours are not there
std::vector<std::string> annotate(Image& picture, const Annotations& annotations);

}  // namespace umbrick
