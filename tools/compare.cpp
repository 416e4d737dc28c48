// umbrick compare tells how far a picture is from its reference.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "compare_report.h"
#include "output_option.h"
#include "picture_output.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"
#include "umbrick/image/colour_map.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"
#include "validators.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct CompareCommand {
  fs::path test, reference;
  std::vector<std::string> layers;  // empty: all
  std::vector<double> background{0, 0, 0};
  DifferenceOptions options;
  Limits limits;
  fs::path difference, flipMap;  // empty: none
  double gain = 1;
  std::string format;  // of these two, where their names do not say
  bool force = false, json = false;
};

void checkOutput(fs::path& path, const CompareCommand& command) {
  if (!path.empty()) pictureFormat(path, command.format);
  prepareOutput(path, command.force);
}

// --- the layers to compare ---

// Returns the name of a layer; the main layer is named by its channels.
std::string nameOf(const ImageLayer& layer) {
  if (!layer.name.empty()) return layer.name;
  return layer.image.channels == 1 ? "Y"
                                   : std::string("RGBA").substr(0, static_cast<std::size_t>(layer.image.channels));
}

std::vector<ImageLayer> readLayers(const fs::path& path) {
  std::vector<ImageLayer> layers;
  if (path.extension() == ".png")
    layers.push_back({"", readPng(path)});
  else
    layers = readExr(path).layers;
  for (ImageLayer& layer : layers) layer.name = nameOf(layer);
  return layers;
}

std::string namesOf(const std::vector<ImageLayer>& layers) {
  std::string names;
  for (const ImageLayer& layer : layers) names += (names.empty() ? "" : ", ") + layer.name;
  return names;
}

const ImageLayer* find(const std::vector<ImageLayer>& layers, const std::string& name) {
  const auto at = std::find_if(layers.begin(), layers.end(), [&](const auto& layer) { return layer.name == name; });
  return at == layers.end() ? nullptr : &*at;
}

const ImageLayer& pick(const std::vector<ImageLayer>& layers, const std::string& name, const fs::path& path) {
  if (const ImageLayer* layer = find(layers, name)) return *layer;
  throw InvalidArgument(path.string() + ": no layer \"" + name + "\": the file has " + namesOf(layers));
}

// Checks that both files hold the same layers, or that --layer says which ones matter.
void checkSameLayers(const CompareCommand& command, const std::vector<ImageLayer>& tests,
                     const std::vector<ImageLayer>& references) {
  std::string common;
  std::size_t count = 0;
  for (const ImageLayer& layer : tests)
    if (find(references, layer.name)) {
      common += " --layer " + layer.name;
      ++count;
    }
  if (count == tests.size() && count == references.size()) return;
  throw InvalidArgument("different layers: " + command.test.string() + " has " + namesOf(tests) + ", " +
                        command.reference.string() + " has " + namesOf(references) +
                        (common.empty() ? "" : "; to compare what both have:" + common));
}

struct Pair {
  std::string name;
  Image test, reference;
};

std::vector<Pair> readPairs(const CompareCommand& command) {
  const std::vector<ImageLayer> tests = readLayers(command.test), references = readLayers(command.reference);
  const Image &a = tests.front().image, &b = references.front().image;
  if (a.width != b.width || a.height != b.height)
    throw InvalidArgument("different sizes: " + command.test.string() + " has " + std::to_string(a.width) + " x " +
                          std::to_string(a.height) + " pixels, " + command.reference.string() + " has " +
                          std::to_string(b.width) + " x " + std::to_string(b.height));
  std::vector<std::string> names = command.layers;
  if (names.empty()) {
    checkSameLayers(command, tests, references);
    for (const ImageLayer& layer : tests) names.push_back(layer.name);
  }
  std::vector<Pair> pairs;
  for (const std::string& name : names) {
    pairs.push_back({name, pick(tests, name, command.test).image, pick(references, name, command.reference).image});
    const int channels = pairs.back().test.channels, others = pairs.back().reference.channels;
    if (channels != others)
      throw InvalidArgument("layer " + name + ": " + command.test.string() + " has " + std::to_string(channels) +
                            " channels, " + command.reference.string() + " has " + std::to_string(others));
  }
  return pairs;
}

// --- pictures of the difference ---

// Returns |difference| * gain as the number that a byte of the PNG shows, so before the sRGB curve is undone. One
// channel becomes grey. A value that is finite in one picture only gets the greatest brightness.
Image shownDifference(const Image& difference, double gain) {
  Image shown(difference.width, difference.height, 4);
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        if (difference.channels == 2 && c == 2) break;
        const double value = difference.at(x, y)[difference.channels == 1 ? 0 : c];
        shown.at(x, y)[c] =
            static_cast<float>(std::isfinite(value) ? srgbToLinear(std::min(1.0, std::abs(value) * gain)) : 1);
      }
      shown.at(x, y)[3] = 1;
    }
  return shown;
}

void writeDifference(const CompareCommand& command, const std::vector<Pair>& pairs) {
  if (pictureFormat(command.difference, command.format) == "png") {
    const Pair& first = pairs.front();
    writePng(command.difference, shownDifference(signedDifference(first.test, first.reference), command.gain));
    return;
  }
  std::vector<ImageLayer> layers;
  for (const Pair& pair : pairs) {
    // The main layer gets its empty name back.
    const bool main = pair.name == nameOf({"", pair.test});
    layers.push_back({main ? "" : pair.name, signedDifference(pair.test, pair.reference)});
  }
  ExrOptions options;
  options.pixel = ExrPixel::float32;
  writeExr(command.difference, layers, options);
}

void writeFlipMap(const CompareCommand& command, const std::vector<Pair>& pairs) {
  const auto pair = std::find_if(pairs.begin(), pairs.end(),
                                 [](const Pair& p) { return p.test.channels == 3 || p.test.channels == 4; });
  if (pair == pairs.end())
    throw InvalidArgument("--flip-map: no layer that is compared has FLIP, which needs 3 or 4 channels");
  const Image map = flipMap(pair->test, pair->reference, command.options.background, command.options.pixelsPerDegree);
  if (pictureFormat(command.flipMap, command.format) == "png")
    return writePng(command.flipMap, colourMapped(map, 0, 1));
  ExrOptions options;
  options.pixel = ExrPixel::float32;
  writeExr(command.flipMap, {{"FLIP", map}}, options);
}

int compare(CompareCommand& command) {
  checkOutput(command.difference, command);
  checkOutput(command.flipMap, command);
  checkApart({command.test, command.difference, command.flipMap});
  checkApart({command.reference, command.difference, command.flipMap});
  for (int c = 0; c < 3; ++c) command.options.background[c] = command.background[static_cast<std::size_t>(c)];
  const std::vector<Pair> pairs = readPairs(command);
  Comparison comparison{command.test.string(),
                        command.reference.string(),
                        {pairs.front().test.width, pairs.front().test.height},
                        command.options,
                        {},
                        {}};
  for (const Pair& pair : pairs)
    comparison.layers.push_back(
        {pair.name, pair.test.channels, differenceOf(pair.test, pair.reference, command.options)});
  comparison.verdicts = judge(comparison.layers, command.limits);
  if (!command.flipMap.empty()) writeFlipMap(command, pairs);
  if (!command.difference.empty()) writeDifference(command, pairs);
  if (command.json)
    printJson(comparison);
  else
    printTable(comparison);
  complain(comparison);
  return std::all_of(comparison.verdicts.begin(), comparison.verdicts.end(), [](const auto& v) { return v.passed; })
             ? 0
             : 1;
}

}  // namespace

Command addCompare(CLI::App& app) {
  const auto command = std::make_shared<CompareCommand>();
  CLI::App* sub = app.add_subcommand(
      "compare", "Measure how far a picture is from its reference; exit status 1 if a limit is not kept.");
  sub->add_option("test", command->test, "the picture: .exr or .png")->required();
  sub->add_option("reference", command->reference, "what it should be: .exr or .png")->required();
  sub->add_option("--layer", command->layers,
                  "compare this layer: RGBA (or RGB, Y) for the main one, or its name; may be repeated "
                  "[all, which must be the same in both]")
      ->type_size(1)
      ->allow_extra_args(false);
  sub->add_flag("--json", command->json, "print JSON instead of a table");

  const std::string limits = "Limits, of every layer that is compared";
  for (std::size_t i = 0; i < kMeasures.size(); ++i) {
    const Measure& measure = kMeasures[i];
    sub->add_option(measure.option, command->limits[i], measure.help)
        ->check(measure.higherIsBetter ? numberIn(-1, 1, "-1 to 1") : nonNegativeNumber())
        ->group(limits);
  }

  const std::string viewing = "Viewing, of SSIM and FLIP";
  sub->add_option("--background", command->background, "behind transparent pictures, linear RGB")
      ->expected(3)
      ->check(numberIn(0, 1, "0 to 1"))
      ->capture_default_str()
      ->group(viewing);
  sub->add_option("--ppd", command->options.pixelsPerDegree,
                  "pixels per degree of visual angle, for FLIP; the default is 0.7 m from a display 0.7 m and 3840 "
                  "pixels wide")
      ->check(numberIn(1, 1000, "1 to 1000"))
      ->capture_default_str()
      ->group(viewing);

  const std::string output = "Output";
  CLI::Option* difference = sub->add_option("--difference", command->difference,
                                            ".png: |test - reference| times --gain of the first layer, byte 255 for 1, "
                                            "without alpha; .exr: test - reference of all layers, float");
  difference->group(output);
  sub->add_option("--gain", command->gain, "of the PNG of --difference")
      ->check(positiveNumber())
      ->needs(difference)
      ->capture_default_str()
      ->group(output);
  sub->add_option("--flip-map", command->flipMap,
                  "FLIP of each pixel: .png: 0 black to 1 light yellow; .exr: FLIP, float")
      ->group(output);
  addPictureFormat(*sub, command->format)->group(output);
  addForceOption(*sub, command->force)->group(output);
  return {sub, [command] { return compare(*command); }};
}

}  // namespace umbrick::tools
