// SPDX-License-Identifier: Apache-2.0
#include "option_words.h"

#include <array>
#include <exception>
#include <string_view>
#include <utility>

#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/scene/scene_fields.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick::tools {
namespace {

// The fields of ConvertOptions that the library's messages name, longer ones before those that they begin with.
constexpr std::array<std::pair<std::string_view, std::string_view>, 27> kWords{{
    {"options.grids", "--grid"},
    {"options.isosurface", "--isosurface"},
    {"options.names", "--name"},
    {"options.units", "--unit"},
    {"options.verify", "--verify"},
    {"output.codec", "--codec"},
    {"output.format .", "--format "},
    {"output.nano adaptive", "--quantise n"},
    {"output.nano bits", "--quantise "},
    {"output.nano", "--quantise"},
    {"options.eachComponent", "--component all"},
    {"options.labels", "--labels"},
    {"output.target", "--to"},
    {"build.background", "--background"},
    {"build.clipBelow", "--threshold, --clip-below or --range"},
    {"build.half", "--half"},
    {"build.maxError", "--max-error"},
    {"build.step", "--step"},
    {"build.tolerance", "--tolerance"},
    {"source.crop", "--crop"},
    {"source.mask", "--mask"},
    {"source.open.parts.component", "--component"},
    {"source.backgroundFromBorder", "--background auto"},
    {"source.resample", "--resample"},
    {"source.open.lengthUnit", "--length-unit"},
    {"source.open.origin", "--origin"},
    {"source.open.spacing", "--spacing"},
}};

// What an option can do about an error of a reader.
std::string hintOf(const std::exception& error) {
  if (dynamic_cast<const SegmentsFound*>(&error)) return "; convert --labels makes them";
  if (dynamic_cast<const SeveralPhases*>(&error)) return "; --where Tag=value picks";
  if (dynamic_cast<const OddSlices*>(&error)) return "; it is left out where --series names the series";
  if (dynamic_cast<const UnplacedSlices*>(&error)) return "; give --spacing";
  if (dynamic_cast<const UnevenSlices*>(&error)) return "; convert --resample interpolates to an even grid";
  if (dynamic_cast<const SeveralGrids*>(&error)) return "; give --grid";
  if (dynamic_cast<const UnknownFormat*>(&error)) return ": give --dims and --type";
  if (dynamic_cast<const StatedPlace*>(&error)) return "; convert --override takes yours";
  if (dynamic_cast<const VectorGridFound*>(&error)) return "; render --component x, y, z or magnitude shows a vec3";
  if (dynamic_cast<const SeveralParts*>(&error))
    return std::string_view(error.what()).find(": a sequence of ") != std::string_view::npos
               ? "; give --frame N, or convert all with -o and a numbered name, as out_%04d.vdb"
               : "; give --component N or --component magnitude";
  return {};
}

std::string hint(const OptionsError& error) try {
  std::rethrow_if_nested(error);
  return {};
} catch (const UnknownFormat&) {
  return ": give --dims and --type";
} catch (const SeveralSeries&) {
  return "; give --series";
} catch (const StatedPlace&) {
  return "; --override takes yours";
} catch (const InvalidArgument&) {
  return {};
}

}  // namespace

std::string inOptionWords(const OptionsError& error) {
  std::string text = error.what();
  for (const auto& [field, option] : kWords)
    for (std::size_t at = 0; (at = text.find(field, at)) != std::string::npos; at += option.size())
      text.replace(at, field.size(), option);
  return text + hint(error);
}

std::string inOptionWords(const std::exception& error) {
  std::string text = error.what();
  const std::size_t end = text.find(':');
  const SceneField* field = end == std::string::npos ? nullptr : findSceneField(text.substr(0, end));
  // A field that an option sets by its name needs no more words.
  if (field && !field->option.empty() && text.substr(0, end) == field->path)
    text.insert(end, " (--" + std::string(field->option) + ")");
  return text + hintOf(error);
}

}  // namespace umbrick::tools
