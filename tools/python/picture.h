// A picture as Python holds it: pixels, layers, what it was made from and how far off it is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "umbrick/draw/progressive.h"
#include "umbrick/scene/annotations.h"

namespace umbrick::python {

struct PictureHandle {
  Image colour;                        // linear premultiplied RGBA
  std::vector<ImageLayer> layers;      // V, Z and others, by name
  std::optional<ResolvedScene> scene;  // none of a picture from a file
  std::string sceneText;               // JSON; empty: not known
  VolumeUnits units;
  std::string engine;                                       // what drew
  std::vector<std::pair<std::string, std::string>> chosen;  // keywords that repeat what was chosen, with their values
  std::vector<std::string> reasons, notes;
  RenderStats stats;
  double ms = 0;  // to draw
  /// Of a progressive picture.
  struct Progress {
    int passes = 0;
    double seconds = 0;
    ErrorEstimate error;
    bool reachedTarget = false;
    std::uint64_t seed = 1;
  };
  std::optional<Progress> progressive;
  std::map<std::string, std::string> metadata;  // that a file gets besides
};

/// Returns an image as an array of height x width (x channels), row 0 at the top, that shares its memory.
/// @param owner  keeps the image alive
pybind11::object arrayOf(const Image& image, const pybind11::object& owner);
/// Copies an array of that shape to an image. @throw InvalidArgument  another shape or dtype
Image imageOf(const pybind11::object& array, const std::string& name);

/// Takes colour, layers and statistics of a picture that was drawn.
void takePicture(Picture picture, const ResolvedScene& scene, PictureHandle& handle);

void addPicture(pybind11::module_& module);

}  // namespace umbrick::python
