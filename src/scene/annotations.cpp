// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/annotations.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>

#include "umbrick/core/short_number.h"
#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

constexpr int kBarColours = 256;
constexpr double kLongestBar = 0.25;  // of the width of the picture

std::string printed(double number, const std::string& unit) {
  const std::string text = shortNumber(number, 4);
  return unit.empty() ? text : text + " " + unit;
}

glm::dvec3 fromSrgb(double r, double g, double b) { return {srgbToLinear(r), srgbToLinear(g), srgbToLinear(b)}; }

// Returns the medium at a value; of a 2D function the densest one that it has there.
Medium mediumAt(const TransferFunction& transfer, double value) {
  if (!transfer.is2d()) return transfer(value);
  Medium densest = transfer(value, transfer.gradients().front());
  for (const double gradient : transfer.gradients()) {
    const Medium medium = transfer(value, gradient);
    if (medium.sigma_t > densest.sigma_t) densest = medium;
  }
  return densest;
}

// Tells whether a letter is a side of a patient.
bool isSide(char letter) { return std::string_view("LRAPSI").find(letter) != std::string_view::npos; }

}  // namespace

std::vector<TriadAxis> worldTriad(const Camera& camera, const std::string& space) {
  const CameraFrame frame = cameraFrame(camera);
  // Red, green and blue, light enough to be told apart on a dark rim.
  const glm::dvec3 colours[]{fromSrgb(1, 0.42, 0.36), fromSrgb(0.45, 0.88, 0.40), fromSrgb(0.48, 0.68, 1)};
  const char* const labels[]{"x", "y", "z"};
  const bool patient = space.size() == 3 && std::all_of(space.begin(), space.end(), isSide);
  std::vector<TriadAxis> axes;
  for (int i = 0; i < 3; ++i) {
    TriadAxis axis;
    axis.end = {frame.right[i], frame.up[i]};
    axis.depth = frame.forward[i];
    axis.label = patient ? std::string(1, space[static_cast<std::size_t>(i)]) : labels[i];
    axis.colour = colours[i];
    axes.push_back(axis);
  }
  return axes;
}

double pixelsPerUnit(const Camera& camera) {
  const double pixel = screenPlane(camera).pixelSize.x;
  if (camera.projection == Projection::orthographic) return 1 / pixel;
  return 1 / (pixel * glm::length(camera.lookAt - camera.eye));
}

double roundLength(double longest) {
  const double power = std::pow(10, std::floor(std::log10(longest)));
  for (const double digit : {10.0, 5.0, 2.0})
    if (digit * power <= longest * (1 + 1e-12)) return digit * power;
  return power;
}

ScaleBar scaleBar(const Camera& camera, const std::string& lengthUnit) {
  const double perUnit = pixelsPerUnit(camera);
  const double length = roundLength(kLongestBar * camera.width / perUnit);
  std::string label = printed(length, lengthUnit.empty() ? "units" : lengthUnit);
  if (camera.projection == Projection::perspective) label += " at the centre";
  return {length * perUnit, label};
}

ColourBar colourBar(const ResolvedScene& scene, const std::string& valueUnit, const Look& look) {
  const TransferFunction& transfer = scene.transfer;
  const double low = transfer.values().front(), high = transfer.values().back();
  ColourBar bar;
  bar.low = printed(low, valueUnit);
  // A single step has no extent: it has one value, and the media on both sides of it.
  if (high > low) bar.high = printed(high, valueUnit);
  const double margin = high > low ? 0 : std::max(1.0, std::abs(low));
  double most = 0;
  for (int i = 0; i < kBarColours; ++i) {
    const double share = (i + 0.5) / kBarColours;
    const Medium medium = mediumAt(transfer, low - margin + share * (high - low + 2 * margin));
    bar.colours.push_back(displayed(medium.albedo * scene.ambient, look));
    bar.opacities.push_back(medium.sigma_t);
    most = std::max(most, medium.sigma_t);
  }
  for (double& opacity : bar.opacities) opacity = most > 0 ? opacity / most : 0;
  return bar;
}

Annotations annotationsOf(const ResolvedScene& scene, const std::vector<Annotation>& wanted, const VolumeUnits& units,
                          const Look& look) {
  Annotations annotations;
  for (const Annotation annotation : wanted) {
    if (annotation == Annotation::triad) annotations.triad = worldTriad(scene.camera, units.space);
    if (annotation == Annotation::scale) annotations.scale = scaleBar(scene.camera, units.length);
    if (annotation == Annotation::colours) annotations.colours = colourBar(scene, units.value, look);
  }
  return annotations;
}

}  // namespace umbrick
