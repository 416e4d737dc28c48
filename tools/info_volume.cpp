// SPDX-License-Identifier: Apache-2.0
#include "info_volume.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <iostream>
#include <optional>

#include "command.h"
#include "info_text.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/core/printable.h"
#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/list_arrays.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/ingest/segment_source.h"
#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/volume_values.h"
#include "umbrick/render/open_reference.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct Described {
  fs::path input;
  std::vector<NumberedFile> frames;  // of a numbered sequence, the first of which is described
  std::vector<DicomSeries> series;
  std::vector<ArrayRow> arrays;
  std::optional<VolumeInfo> volume;  // nothing where there are several and none is picked
  bool several = false;              // it has several frames, components or segments, none of which is picked
  std::optional<VolumeValues> values;
};

// Takes several volumes of which none is picked for something to list.
std::optional<VolumeInfo> openOrList(const fs::path& file, const OpenOptions& open, Described& found) try {
  return openVolume(file, open)->info();
} catch (const SeveralSeries&) {
  return std::nullopt;
} catch (const SeveralParts& several) {
  found.several = true;
  return several.info;
} catch (const SegmentsFound&) {
  const auto segments = openDicomSegments(file, open.lengthUnit);
  if (!segments) throw;
  found.several = true;
  return segments->info();
} catch (const IoError&) {
  // Arrays of which none is the only one.
  const auto volumes =
      std::count_if(found.arrays.begin(), found.arrays.end(), [](const auto& row) { return row.volume; });
  if (volumes == 1 || found.arrays.empty()) throw;
  return std::nullopt;
}

bool isPipe(const fs::path& file) { return fs::exists(file) && !fs::is_regular_file(file) && !fs::is_directory(file); }

Described describeInput(const fs::path& input, const VolumeOptions& options, int bins) {
  Described found;
  found.input = input;
  fs::path file = input;
  VolumeReference reference;
  reference.file = input;
  applyVolumeOptions(options, reference);
  const OpenOptions open = openOptions(reference);
  const auto format = open.raw ? std::nullopt : formatOfName(input);
  if (isFramePattern(input) && format != "images") {
    found.frames = listFrames(input);
    file = found.frames.front().path;
  }
  if (!open.raw && !isPipe(file) && fs::exists(file)) {
    if (formatOfFile(file) == "DICOM") found.series = listDicomSeries(file);
    found.arrays = listArrays(file);
  }
  found.volume = openOrList(file, open, found);
  if (found.volume && !found.several && !isPipe(file))
    found.values = volumeValues([&] { return openVolume(file, open); }, bins);
  return found;
}

nlohmann::json toJson(const DicomSeries& series) {
  return {{"uid", series.uid},
          {"number", series.number},
          {"description", series.description},
          {"modality", series.modality},
          {"files", series.files.size()}};
}

nlohmann::json toJson(const VolumeLabel& label) {
  nlohmann::json out{{"name", label.name}, {"value", label.value}};
  if (label.component != 0) out["component"] = label.component;
  if (label.colour) out["colour"] = jsonVector(*label.colour);
  return out;
}

std::string pickText(const VolumeInfo& info) {
  std::string text;
  if (info.frames > 1) text = "--frame 0 to " + std::to_string(info.frames - 1);
  if (info.frames == 1 && info.components == 1) return "convert --labels, or some of them by value or name";
  if (info.components > 1)
    text += (text.empty() ? "" : ", ") + std::string("--component 0 to ") + std::to_string(info.components - 1) +
            " or magnitude";
  return text;
}

nlohmann::json toJson(const ArrayRow& array) {
  return {{"name", array.name}, {"shape", array.shape}, {"type", array.type}, {"volume", array.volume}};
}

template <class Rows>
void addList(nlohmann::json& out, const char* key, const Rows& rows) {
  if (rows.empty()) return;
  out[key] = nlohmann::json::array();
  for (const auto& row : rows) out[key].push_back(toJson(row));
}

nlohmann::json toJson(const VolumeInfo& info) {
  nlohmann::json out{{"dims", jsonVector(info.dims)}, {"type", voxelTypeName(info.type)},
                     {"file_bytes", info.fileBytes},  {"components", info.components},
                     {"frames", info.frames},         {"index_to_world", jsonMatrix(info.indexToWorld)},
                     {"metadata", info.metadata},     {"notes", info.notes}};
  nlohmann::json spacing = nlohmann::json::array();
  for (int axis = 0; axis < 3; ++axis) spacing.push_back(glm::length(glm::dvec3(info.indexToWorld[axis])));
  out["spacing"] = spacing;
  out["origin"] = jsonVector(info.indexToWorld[3]);
  if (info.components > 1) out["meaning"] = meaningName(info.meaning);
  addList(out, "labels", info.labels);
  return out;
}

nlohmann::json toJson(const Described& found) {
  nlohmann::json out{{"file", asUtf8(found.input.string())}};
  if (found.volume) out["volume"] = toJson(*found.volume);
  if (found.volume && found.several) out["to_pick"] = pickText(*found.volume);
  if (found.values) {
    out["values"] = {{"non_finite", found.values->nonFinite}, {"histogram", found.values->histogram}};
    if (!found.values->histogram.empty()) {
      out["values"]["min"] = found.values->min;
      out["values"]["max"] = found.values->max;
    }
  }
  if (!found.frames.empty())
    out["frames"] = {
        {"first", found.frames.front().number}, {"last", found.frames.back().number}, {"count", found.frames.size()}};
  addList(out, "series", found.series);
  addList(out, "arrays", found.arrays);
  return out;
}

void printLine(const std::string& field, const std::string& value) {
  std::cout << "  " << field << std::string(field.size() < 15 ? 15 - field.size() : 1, ' ') << printable(value) << '\n';
}

std::string numberText(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

// Texts of files may be long, and of several lines.
std::string oneLine(std::string text) {
  constexpr std::size_t kMostShown = 160;
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  if (text.size() > kMostShown) text = text.substr(0, kMostShown) + "...";
  return text;
}

void printPlace(const VolumeInfo& info) {
  const auto found = info.metadata.find("length_unit");
  const std::string unit = found == info.metadata.end() ? " world units" : ' ' + found->second;
  const glm::dmat4& m = info.indexToWorld;
  glm::dvec3 spacing(0);
  bool upright = true;
  for (int axis = 0; axis < 3; ++axis) {
    spacing[axis] = glm::length(glm::dvec3(m[axis]));
    for (int row = 0; row < 3; ++row) upright = upright && (row == axis ? m[axis][row] > 0 : m[axis][row] == 0);
  }
  printLine("spacing", text(spacing, " x ") + unit);
  printLine("first voxel", '(' + text(m[3]) + ')');
  if (upright) return;
  std::string axes;
  for (int axis = 0; axis < 3; ++axis) axes += (axis == 0 ? "(" : ", (") + text(m[axis] / spacing[axis]) + ')';
  printLine("axes", axes);
}

void printVolume(const VolumeInfo& info) {
  const auto bytes = info.dims.x * info.dims.y * info.dims.z * voxelBytes(info.type);
  printLine("voxels", text(info.dims, " x ") + ' ' + std::string(voxelTypeName(info.type)) + ", " +
                          std::to_string(bytes) + " bytes unpacked");
  if (info.frames > 1) printLine("frames", std::to_string(info.frames));
  if (info.components > 1) printLine("components", std::to_string(info.components) + ", " + meaningName(info.meaning));
  printPlace(info);
  for (const VolumeLabel& label : info.labels)
    printLine("label", std::to_string(label.value) + (label.name.empty() ? "" : ": " + oneLine(label.name)));
  printSource(info.metadata);
  for (const auto& [key, value] : info.metadata)
    if (!isUsualSource(key)) printLine(key, oneLine(value));
  for (const std::string& note : info.notes) printLine("note", note);
}

void printValues(const VolumeValues& values) {
  if (values.nonFinite > 0) printLine("not finite", std::to_string(values.nonFinite) + " voxels");
  if (values.histogram.empty()) return;
  printLine("values", numberText(values.min) + " to " + numberText(values.max) + ", voxels by value:");
  printHistogram(values.histogram, values.min, values.max);
}

void printSeries(const Described& found) {
  std::size_t place = 0;
  for (const DicomSeries& series : found.series)
    printLine("series " + std::to_string(++place),
              std::to_string(series.files.size()) + (series.files.size() == 1 ? " file, " : " files, ") +
                  series.modality + (series.description.empty() ? "" : ", \"" + series.description + '"') +
                  ", number " + std::to_string(series.number) + ", UID " + series.uid);
  if (!found.volume && !found.series.empty()) printLine("to pick one", "--series 1, or its UID");
}

void printArrays(const Described& found) {
  for (const ArrayRow& array : found.arrays)
    printLine("array", array.name + ": " + array.shape + ", " + array.type + (array.volume ? "" : " (no volume)"));
  const auto pick = std::find_if(found.arrays.begin(), found.arrays.end(), [](const auto& row) { return row.volume; });
  if (!found.volume && pick != found.arrays.end())
    printLine("to pick one", found.input.filename().string() + ':' + pick->name);
}

void print(const Described& found) {
  std::cout << printable(found.input.string()) << ": ";
  if (!found.frames.empty())
    std::cout << found.frames.size() << " frames, " << found.frames.front().number << " to "
              << found.frames.back().number << "; of the first: ";
  if (found.volume)
    std::cout << found.volume->fileBytes << " bytes\n";
  else
    std::cout << "several volumes\n";
  if (found.volume) printVolume(*found.volume);
  if (found.volume && found.several) printLine("to pick one", pickText(*found.volume));
  printSeries(found);
  printArrays(found);
  if (found.values) printValues(*found.values);
}

}  // namespace

void printVolumeInfo(const fs::path& input, const VolumeOptions& options, int bins, bool json) {
  const Described found = describeInput(input, options, bins);
  if (json)
    printJson(toJson(found));
  else
    print(found);
}

}  // namespace umbrick::tools
