// SPDX-License-Identifier: Apache-2.0
#include "picture_output.h"

#include <algorithm>
#include <iostream>

#include "command.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/image/png.h"

namespace umbrick::tools {
namespace {
bool isExr(const std::filesystem::path& path) { return path.extension() == ".exr"; }

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
                  "picture: .exr (linear, premultiplied) or .png (sRGB, alpha); may be repeated")
      ->required()
      ->type_size(1)
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("--exr-pixel", output->exrPixel, "half or float")
      ->check(CLI::IsMember(listNames(kExrPixels)))
      ->capture_default_str()
      ->group(group);
  command.add_flag("--layers", output->layers, "add to the EXR: " + layers)->group(group);
  command.add_option("--tone-map", output->toneMap, "of the PNG: none, reinhard or filmic")
      ->check(CLI::IsMember(listNames(kToneMaps)))
      ->capture_default_str()
      ->group(group);
  command.add_option("--exposure", output->exposure, "of the PNG, stops")->capture_default_str()->group(group);
  command.add_option("--stats", output->stats, "write times, counts and the scene as JSON")->group(group);
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

void checkOutputs(const PictureOutput& output) {
  std::vector<std::filesystem::path> files = output.files;
  files.push_back(output.stats);
  checkApart(files);
  for (const std::filesystem::path& path : output.files) {
    if (!isExr(path) && path.extension() != ".png")
      throw UsageError(path.string() + ": expected a picture that ends in .exr or .png");
    PendingFile probe(path);
  }
  if (!output.stats.empty()) PendingFile probe(output.stats);
}

void printOutputs(const PictureOutput& output) {
  for (const std::filesystem::path& path : output.files) std::cout << path.string() << '\n';
}

void writeOutputs(const PictureOutput& output, const std::vector<ImageLayer>& layers,
                  const std::map<std::string, std::string>& metadata) {
  for (const std::filesystem::path& path : output.files) {
    if (isExr(path)) {
      ExrOptions options;
      options.pixel = parseName(kExrPixels, output.exrPixel, "--exr-pixel");
      options.metadata = metadata;
      if (options.pixel == ExrPixel::half) tellClipped(path, layers);
      writeExr(path, layers, options);
    } else {
      PngOptions options;
      options.toneMap = parseName(kToneMaps, output.toneMap, "--tone-map");
      options.exposure = static_cast<float>(output.exposure);
      if (const auto scene = metadata.find("umbrick.scene"); scene != metadata.end()) options.metadata.insert(*scene);
      writePng(path, layers.front().image, options);
    }
  }
}

}  // namespace umbrick::tools
