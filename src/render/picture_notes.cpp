// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/picture_notes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "umbrick/core/short_number.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

enum class Emptiness { none, nothing, everything };

Emptiness findEmptiness(const Image& colour, const ResolvedScene& scene) {
  constexpr float kStep = 1.0f / 255;
  const glm::dvec3 behind = scene.background.value_or(glm::dvec3(0));
  bool nothing = true, everything = !scene.background;
  for (std::size_t i = 0; i + 3 < colour.pixels.size() && (nothing || everything); i += 4) {
    const float alpha = colour.pixels[i + 3];
    everything = everything && alpha >= 1 - 0.5f * kStep;
    for (std::size_t c = 0; c < 3; ++c)
      nothing = nothing && std::abs(colour.pixels[i + c] - float(behind[int(c)])) <= kStep;
    if (!scene.background) nothing = nothing && alpha <= kStep;
  }
  return nothing ? Emptiness::nothing : everything ? Emptiness::everything : Emptiness::none;
}

// Returns the intervals of values that a function shows: "from 0.5 to 2 and above 8".
std::string shownValues(const TransferFunction& transfer) {
  const std::vector<double>& values = transfer.values();
  const auto visible = [&](std::size_t i) {
    for (std::size_t row = 0; row * values.size() < transfer.media().size(); ++row)
      if (transfer.media()[row * values.size() + i].sigma_t > 0) return true;
    return false;
  };
  std::string text;
  int pieces = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!visible(i)) continue;
    std::size_t last = i;
    while (last + 1 < values.size() && visible(last + 1)) ++last;
    const bool open = last + 1 == values.size(), below = i == 0;
    const double from = values[i > 0 ? i - 1 : 0], to = values[std::min(last + 1, values.size() - 1)];
    i = last;
    if (++pieces > 3) continue;
    if (!text.empty()) text += ", ";
    if (open && below)
      text += "all values";
    else if (open)
      text += "above " + shortNumber(from, 4);
    else if (below)
      text += "below " + shortNumber(to, 4);
    else
      text += "from " + shortNumber(from, 4) + " to " + shortNumber(to, 4);
  }
  if (text.empty()) return "none";
  return pieces > 3 ? text + ", ..." : text;
}

}  // namespace

std::optional<std::string> describeEmptyPicture(const Image& colour, const ResolvedScene& scene, const Volume& volume,
                                                const AskedScene& words) {
  const Emptiness found = findEmptiness(colour, scene);
  if (found == Emptiness::none) return std::nullopt;
  // What other modes show may well fill the picture, and does not depend on what the transfer function shows.
  if (scene.mode != Mode::integrate && scene.mode != Mode::xray) {
    if (found == Emptiness::everything) return std::nullopt;
    const std::string what = traitsOf(scene.mode).surfaces ? "a surface" : "anything but the background";
    const bool clips = !scene.clipPlanes.empty() || scene.clipBox.has_value();
    return "nothing is drawn: no ray meets " + what + "; try " + (clips ? "no clipping, or " : "") +
           "a camera around the volume (no " + words.nameOf("eye") + ")";
  }
  const std::string tryAuto = "; try " + words.nameOf("tf") + " auto";
  const ValueSurvey values = surveyValues(volume.grid());
  std::string text = found == Emptiness::nothing ? "nothing is drawn" : "every pixel is opaque";
  if (values.voxels == 0) return text + ": the volume has no finite value";
  text += ": the volume has values from " + shortNumber(values.value.min, 4) + " to " +
          shortNumber(values.value.max, 4) + " (most from " + shortNumber(values.low, 4) + " to " +
          shortNumber(values.high, 4) + ")";
  if (!volume.valueUnit().empty()) text += " in " + volume.valueUnit();
  text += ", the transfer function shows " + shownValues(scene.transfer);
  const bool meets =
      scene.transfer.majorant(values.value, scene.transfer.is2d() ? scene.transfer.gradientDomain() : Range{0, 0}) > 0;
  if (found == Emptiness::everything)
    return text + tryAuto + ", a smaller " + words.nameOf("sigma-scale") + ", or a camera farther away (" +
           words.nameOf("zoom") + " 0.5)";
  if (!meets) return text + tryAuto + ", or " + words.nameOf("window") + " with two of these values";
  const bool clipped = !scene.clipPlanes.empty() || scene.clipBox.has_value();
  return text + tryAuto + ", a larger " + words.nameOf("sigma-scale") + (clipped ? ", no clipping" : "") +
         ", or a camera around the volume (no " + words.nameOf("eye") + ")";
}

std::vector<std::string> notesOn(const Picture& picture, const ResolvedScene& scene, const AskedScene& words) {
  std::vector<std::string> notes;
  const auto add = [&](const auto&... parts) {
    std::ostringstream line;
    (line << ... << parts);
    notes.push_back(line.str());
  };
  // A format that is asked for by name may round voxels; the automatic choice does not.
  if (scene.bricks.format != "auto" && picture.stats.formatError > 0)
    add("texels of ", scene.bricks.format, " are off by up to ", picture.stats.formatError, ", in units of the grid");
  if (picture.stats.lightSpacing == 2 && scene.occlusion.ordinates.lightSpacing == 0)
    add("for lack of memory light is held at every second voxel alone, which changes it by about ",
        picture.stats.lightSpacingError, " of the whole (", words.nameOf("memory-budget"), ")");
  if (!picture.stats.lightNote.empty()) add("light is computed on the CPU: ", picture.stats.lightNote);
  return notes;
}

}  // namespace umbrick
