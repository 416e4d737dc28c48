// SPDX-License-Identifier: Apache-2.0
#include "picture_output.h"

#include <algorithm>
#include <iostream>

#include "command.h"
#include "film.h"
#include "output_option.h"
#include "umbrick/image/png.h"
#include "validators.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {
constexpr std::string_view kAllAnnotations = "all";

bool isExr(const PictureOutput& output, const std::filesystem::path& path) {
  return pictureFormat(path, output.format) == "exr";
}

// Prints how many colours a file of half-floats cuts off.
void tellClipped(const std::filesystem::path& path, const std::vector<ImageLayer>& layers) {
  constexpr float kMost = 65504;
  if (layers.empty()) return;
  const std::vector<float>& values = layers.front().image.pixels;
  const auto clipped = std::count_if(values.begin(), values.end(), [](float value) { return value > kMost; });
  if (clipped > 0)
    std::cerr << path.string() << ": " << clipped
              << " values are above 65504, the most that half-floats hold, and are cut off there; --exr-pixel float "
                 "keeps them\n";
}

}  // namespace

std::shared_ptr<PictureOutput> addPictureOutput(CLI::App& command, const std::string& exrPixel,
                                                const std::string& layers) {
  const auto output = std::make_shared<PictureOutput>();
  output->exrPixel = exrPixel;
  const std::string group = "Output";
  command
      .add_option("-o,--output", output->files,
                  "picture: .exr (linear, premultiplied) or .png (sRGB, alpha), or - for stdout; may be repeated")
      ->required()
      ->type_size(1)
      ->allow_extra_args(false)
      ->group(group);
  addPictureFormat(command, output->format)->group(group);
  addForceOption(command, output->force)->group(group);
  command.add_option("--exr-pixel", output->exrPixel, "half or float")
      ->check(CLI::IsMember(listNames(kExrPixels)))
      ->capture_default_str()
      ->group(group);
  command.add_flag("--layers", output->layers, "add to the EXR: " + layers)->group(group);
  command
      .add_option("--exposure", output->exposure,
                  "of the PNG, stops: radiance times 2^stops, before the tone curve; never of an EXR")
      ->check(numberIn(-kMostStops, kMostStops, "-100 to 100"))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--tone,--tone-map", output->toneMap,
                  "curve of the PNG: none (above 1 is cut off), reinhard or filmic (ACES fit of Narkowicz 2015)")
      ->check(CLI::IsMember(listNames(kToneMaps)))
      ->capture_default_str()
      ->group(group);
  std::vector<std::string> annotations = listNames(kAnnotations);
  annotations.emplace_back(kAllAnnotations);
  command
      .add_option("--annotate", output->annotate,
                  "draw into the PNG, separated by commas: triad (axes x, y, z), scale (bar), colours (of the transfer "
                  "function), or all")
      ->type_size(1)
      ->allow_extra_args(false)
      ->delimiter(',')
      ->check(CLI::IsMember(annotations))
      ->group(group);
  command.add_option("--stats", output->stats, "write times, counts and the scene as JSON; - for stdout")->group(group);
  return output;
}

void checkApart(const std::vector<std::filesystem::path>& files) {
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      std::error_code ignored;
      if (!files[i].empty() && (files[i].lexically_normal() == files[j].lexically_normal() ||
                                std::filesystem::equivalent(files[i], files[j], ignored)))
        throw UsageError(files[i].string() + ": named twice, for things that would overwrite each other");
    }
}

void checkOutputs(PictureOutput& output) {
  for (const std::filesystem::path& path : output.files) pictureFormat(path, output.format);
  for (std::filesystem::path& path : output.files) prepareOutput(path, output.force);
  prepareOutput(output.stats, output.force);
  std::vector<std::filesystem::path> files = output.files;
  files.push_back(output.stats);
  checkApart(files);
}

Look PictureOutput::look() const { return {parseName(kToneMaps, toneMap, "--tone"), exposure, backdrop}; }

VolumeUnits unitsOf(const ScalarGrid& grid) {
  return {grid.metadata("length_unit"), grid.metadata("value_unit"), grid.metadata("space")};
}

std::optional<Annotations> annotationsFor(const PictureOutput& output, const ResolvedScene& scene,
                                          const VolumeUnits& units) {
  std::vector<Annotation> wanted;
  for (const std::string& name : output.annotate) {
    for (const auto& [one, annotation] : kAnnotations)
      if (name == one || name == kAllAnnotations) wanted.push_back(annotation);
  }
  if (wanted.empty()) return {};
  return annotationsOf(scene, wanted, units, output.look());
}

Image shownPicture(const PictureOutput& output, const Image& colour) {
  Image shown = displayed(colour, output.look());
  if (output.annotations) annotate(shown, *output.annotations);
  return shown;
}

void prepareLook(PictureOutput& output, Backdrop backdrop, const ResolvedScene& scene, const VolumeUnits& units) {
  output.backdrop = backdrop;
  output.annotations = annotationsFor(output, scene, units);
  if (output.look() == Look{} && !output.annotations) return;
  const auto isLinear = [&](const fs::path& path) { return !isFilm(path) && isExr(output, path); };
  if (std::all_of(output.files.begin(), output.files.end(), isLinear)) {
    std::cerr << "exposure, tone, gradient and annotations are of a PNG only, and no PNG is asked for\n";
  } else if (output.annotations) {
    // A picture may be written many times: what it has no room for is said once, before.
    Image blank(scene.camera.width, scene.camera.height, 4);
    const std::vector<std::string> leftOut = annotate(blank, *output.annotations);
    if (!leftOut.empty())
      std::cerr << "a picture of " << scene.camera.width << " x " << scene.camera.height
                << " has no room for these annotations, which are left out: " << joined(leftOut) << '\n';
  }
}

void printOutputs(const PictureOutput& output) {
  for (const std::filesystem::path& path : output.files)
    if (!isStream(path)) std::cout << shownName(path) << '\n';
}

void writeOutputs(const PictureOutput& output, const std::vector<ImageLayer>& layers,
                  const std::map<std::string, std::string>& metadata, PictureState state) {
  for (const std::filesystem::path& path : output.files) {
    if (state == PictureState::unfinished && isStream(path)) continue;
    if (isExr(output, path)) {
      ExrOptions options;
      options.pixel = parseName(kExrPixels, output.exrPixel, "--exr-pixel");
      options.metadata = metadata;
      if (options.pixel == ExrPixel::half) tellClipped(path, layers);
      writeExr(path, layers, options);
    } else {
      PngOptions options;
      if (const auto scene = metadata.find("umbrick.scene"); scene != metadata.end()) options.metadata.insert(*scene);
      const Look look = output.look();
      if (look.backdrop == Backdrop::none && !output.annotations) {
        options.toneMap = look.toneMap;
        options.exposure = look.exposure;
        writePng(path, layers.front().image, options);
      } else {
        writePng(path, shownPicture(output, layers.front().image), options);
      }
    }
  }
}

}  // namespace umbrick::tools
