// SPDX-License-Identifier: Apache-2.0
#include "render/volume_file.h"

#include <algorithm>
#include <exception>
#include <string_view>
#include <utility>

#include "core/input_file.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/load_volume.h"
#include "umbrick/core/error.h"
#include "umbrick/core/names.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/emission_grid.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/render/open_reference.h"
#include "umbrick/render/volume.h"
#include "umbrick/vdb/grid_listing.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/read_vectors.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

// What a selector says in front of a component, and the component.
std::pair<std::string, std::string> splitComponent(const std::string& selector) {
  const std::size_t dot = selector.rfind('.');
  if (dot == std::string::npos) return {selector, {}};
  return {selector.substr(0, dot), selector.substr(dot + 1)};
}

void readVolume(VolumeFile& file, const OpenOptions& open, const LoadProgress& progress) {
  const VolumeReference& source = file.source;
  ConvertOptions options;
  options.source.open = open;
  if (progress) options.progress = [&progress](const ConvertProgress& stage) { progress(stage.share); };
  LoadedVolume loaded = loadVolume(source.file, options);
  const auto border = loaded.report.background;
  const bool uniform = loaded.grid.activeBox().empty();
  if (uniform && border && border->value != 0) {
    options.build.background = 0.0f;
    loaded = loadVolume(source.file, options);
    file.notes.push_back("all of its voxels are " + shortNumber(border->value, 6));
  } else if (uniform) {
    throw EmptyVolume(source.file.string() + ": all of its voxels are 0: there is nothing to show");
  } else if (border && border->value != 0) {
    file.notes.push_back("beyond its voxels it is taken to be " + shortNumber(border->value, 6) + ", as at its border");
  }
  file.notes.insert(file.notes.begin(), loaded.report.notes.begin(), loaded.report.notes.end());
  file.grid = std::move(loaded.grid);
}

// Returns labels of the scalar grids of a file in the order in which they are tried.
std::vector<std::string> scalarGrids(const GridListing& listing) {
  std::vector<std::string> labels;
  for (const GridListing::Row& row : listing.grids)
    if (row.scalar) labels.insert(row.label == "density" ? labels.begin() : labels.end(), row.label);
  return labels;
}

// Reads the first scalar grid that holds something.
void readSomeGrid(VolumeFile& file, const std::vector<std::string>& labels, const LoadProgress& progress) {
  std::vector<std::string> empty;
  for (const std::string& label : labels) {
    file.grid = readScalarGrid(file.source.file, label, progress);
    file.source.grid = label;
    if (!file.grid.activeBox().empty()) break;
    empty.push_back(label);
  }
  if (empty.size() == labels.size()) return;  // a volume of nothing is refused by whoever takes it
  std::vector<std::string> others;
  for (const std::string& label : labels)
    if (label != file.source.grid) others.push_back(label);
  file.notes.push_back("grid \"" + file.source.grid + "\" of " + std::to_string(labels.size()) +
                       " (the others: " + joined(others) + (empty.empty() ? ")" : "; empty: " + joined(empty) + ")"));
}

// Reads one number of each voxel of a grid of vec3, where the selector ends in a component and no grid is called so.
bool readComponent(VolumeFile& file, const GridListing& listing, const LoadProgress& progress) {
  const auto [grid, component] = splitComponent(file.source.grid);
  if (component.empty()) return false;
  const std::string name = grid;
  std::string found;
  for (const GridListing::Row& row : listing.grids) {
    if (row.label == file.source.grid || row.label == file.source.grid + "[0]") return false;
    const bool named = row.label == name || row.label == name + "[0]" || name.empty();
    if (found.empty() && named && row.type.starts_with("vec3")) found = row.label;
  }
  if (found.empty()) return false;
  PartChoice choice;
  chooseComponent(component, choice);
  if (choice.component.value_or(0) > 2)
    throw InvalidArgument(file.source.file.string() + ": component: expected 0 to 2, found " + component);
  const auto vectors = readVectorGrid(file.source.file, found, progress);
  file.grid =
      vectorComponent(*vectors, choice.magnitude ? std::nullopt : std::optional(static_cast<int>(*choice.component)));
  file.source.grid = found + '.' + component;
  file.notes.push_back("grid \"" + found + "\" of vec3, " +
                       (choice.magnitude ? std::string("its magnitude") : "its component " + component));
  return true;
}

bool isNamed(const std::string& label, std::string_view name) {
  const std::string base = label.substr(0, label.find('['));
  return std::ranges::equal(base, name,
                            [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b; });
}

// Returns labels of the grids of a file that may emit light, the likeliest first: the one that is asked for, or those
// of known names.
std::vector<std::string> emissionGrids(const VolumeFile& file, const GridListing& listing) {
  if (file.source.emissionGrid != kAutomaticGrid) return {file.source.emissionGrid};
  std::vector<std::string> found;
  for (const std::string_view name : emissionGridNames())
    for (const GridListing::Row& row : listing.grids)
      if (row.scalar && isNamed(row.label, name) && row.label != file.source.grid) found.push_back(row.label);
  return found;
}

// Reads a second grid that emits light, where one is asked for.
void readEmission(VolumeFile& file, const GridListing& listing, const LoadProgress& progress) {
  if (file.source.emissionGrid.empty()) return;
  const bool automatic = file.source.emissionGrid == kAutomaticGrid;
  const std::vector<std::string> labels = emissionGrids(file, listing);
  if (automatic) file.source.emissionGrid.clear();
  for (const std::string& label : labels) {
    const ScalarGrid second = readScalarGrid(file.source.file, label, progress);
    const bool glows = acceptedBox(second, [](double value) { return value > 0; }).empty() == false;
    if (!glows) file.notes.push_back("grid \"" + label + "\" is nowhere above 0: nothing emits light");
    if (!glows && automatic) continue;
    const EmissionReport report = addEmission(file.grid, second);
    if (report.resampled)
      file.notes.push_back("grid \"" + label + "\" lies on a lattice of its own: it is interpolated on that of \"" +
                           file.grid.name + "\", off by up to " + shortNumber(report.max, 3) + " at its voxels (rms " +
                           shortNumber(report.rms, 3) + ")");
    file.source.emissionGrid = label;
    return;
  }
}

void readGrid(VolumeFile& file, const LoadProgress& progress) {
  file.foreign = true;
  const GridListing listing = listGrids(file.source.file);
  for (auto entry = listing.metadata.beginMeta(); entry != listing.metadata.endMeta(); ++entry)
    if (entry->first == "creator" && entry->second) file.creator = entry->second->str();
  if (!readComponent(file, listing, progress)) {
    const std::vector<std::string> labels = scalarGrids(listing);
    if (file.source.grid.empty() && labels.size() > 1)
      readSomeGrid(file, labels, progress);
    else
      file.grid = readScalarGrid(file.source.file, file.source.grid, progress);
  }
  readEmission(file, listing, progress);
}

}  // namespace

std::span<const std::string_view> emissionGridNames() {
  static constexpr std::string_view kNames[]{"temperature", "temp", "heat", "flame", "flames", "fire", "burn"};
  return kNames;
}

VolumeFile readVolumeFile(const VolumeReference& reference, const LoadProgress& progress,
                          const std::shared_ptr<KeptStream>& kept) {
  VolumeFile file;
  file.source = reference;
  if (isFramePattern(reference.file)) {
    const std::vector<NumberedFile> frames = listFrames(reference.file);
    file.source.file = frames.front().path;
    file.notes.push_back("frame " + std::to_string(frames.front().number) + ", the first of " +
                         std::to_string(frames.size()));
  }
  if (reference.besideOnly && fs::is_regular_file(file.source.file)) requireBeside(file.source.file, file.source.file);
  if (!file.source.raw && holdsGrids(file.source.file)) {
    readGrid(file, progress);
  } else {
    if (!file.source.emissionGrid.empty() && file.source.emissionGrid != kAutomaticGrid)
      throw InvalidArgument(file.source.file.string() +
                            ": volume.emissionGrid is for files of grids, and this is a volume: found '" +
                            file.source.emissionGrid + "'");
    file.source.emissionGrid.clear();
    OpenOptions open = openOptions(file.source);
    open.parts.kept = kept;
    readVolume(file, open, progress);
  }
  return file;
}

VolumeFile readVolumeArray(const std::string& name, const OpenOptions& open, const LoadProgress& progress) {
  VolumeFile file;
  file.source.file = name;
  readVolume(file, open, progress);
  return file;
}

}  // namespace umbrick
