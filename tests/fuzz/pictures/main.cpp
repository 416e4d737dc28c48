// Many random scenes: which of their pictures are not what they should be.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/pictures/compare_scene.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {
namespace {

const char* const kUsage =
    "umbrick_fuzz_pictures [--seed-from N=1] [--count M=100] [--kind emission|occlusion|lights|any]\n"
    "                      [--size PIXELS=32] [--json-lines FILE] [--keep DIR] [--keep-all] [--verbose]\n"
    "Renders random scenes and those that must be the same, and compares them with the reference.\n"
    "--size        longest edge of a picture\n"
    "--json-lines  all numbers, a scene a line\n"
    "--keep        writes those that fail as DIR/SEED/grid.vdb and DIR/SEED/scene.json, for umbrick render and "
    "reference\n"
    "--keep-all    keeps those that pass, too\n"
    "--verbose     prints a line for each scene, not only for those that fail\n"
    "Exit status: 0 all passed, 1 some failed, 2 wrong usage.\n";

struct Arguments {
  std::uint64_t seedFrom = 1, count = 100;
  SceneKind kind = SceneKind::emission;
  int size = 32;
  std::filesystem::path jsonLines, keep;
  bool keepAll = false, verbose = false;
};

std::optional<Arguments> parse(const std::vector<std::string>& words) {
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& name = words[i];
    if (name == "--verbose" || name == "--keep-all") {
      (name == "--verbose" ? arguments.verbose : arguments.keepAll) = true;
      continue;
    }
    if (i + 1 == words.size()) return std::nullopt;
    const std::string& value = words[++i];
    if (name == "--seed-from")
      arguments.seedFrom = std::stoull(value);
    else if (name == "--count")
      arguments.count = std::stoull(value);
    else if (name == "--kind")
      arguments.kind = parseSceneKind(value);
    else if (name == "--size")
      arguments.size = std::clamp(std::stoi(value), 4, 512);
    else if (name == "--json-lines")
      arguments.jsonLines = value;
    else if (name == "--keep")
      arguments.keep = value;
    else
      return std::nullopt;
  }
  return arguments;
}

nlohmann::ordered_json describe(std::uint64_t seed, const RandomScene& random, const SceneComparison& found) {
  nlohmann::ordered_json json;
  json["seed"] = seed;
  json["scene"] = random.description;
  json["opacity"] = found.opacity;
  json["seconds"] = found.seconds;
  const auto add = [&](const char* name, const PictureDistance& distance, double limit) {
    json[name] = {{"rms", distance.rms}, {"max", distance.max}};
    if (limit < 1e30) json[name]["limit"] = limit;
  };
  json["depth"] = found.depth;
  const bool emission = random.scene.model == Model::emission;
  add("render", found.render, found.renderLimit);
  add("fine", found.fineRender, found.fineLimit);
  if (emission) {
    add("slabs", found.slabs, INFINITY);
    add("fine_slabs", found.fineSlabs, INFINITY);
    add("reference", found.reference, found.referenceLimit);
  }
  for (const VariantDistance& variant : found.variants)
    json["variants"][variant.name] = {{"rms", variant.from.rms}, {"max", variant.from.max}, {"limit", variant.limit}};
  json["failures"] = found.failures;
  return json;
}

void keep(const std::filesystem::path& folder, RandomScene random, const SceneComparison& found) {
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / "grid.vdb");
  writeGrids(folder / "grid.vdb", {random.grid.grid});
  random.scene.volume.file = "grid.vdb";
  std::ofstream(folder / "scene.json") << printScene(random.scene) << '\n';
  std::ofstream about(folder / "about.txt");
  about << random.description << '\n';
  for (const std::string& failure : found.failures) about << failure << '\n';
}

std::string distribution(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
  };
  char text[128];
  std::snprintf(text, sizeof text, "median %.2g, 90 %% %.2g, 99 %% %.2g, largest %.2g", at(0.5), at(0.9), at(0.99),
                values.back());
  return text;
}

// One kind of comparison, over all scenes.
struct Tally {
  std::vector<double> rms;
  std::uint64_t failed = 0;
};

int run(const Arguments& arguments) {
  const std::unique_ptr<GlContext> context = createGlContext();
  std::cout << context->description() << ", seeds from " << arguments.seedFrom << '\n';
  std::ofstream lines;
  if (!arguments.jsonLines.empty()) lines.open(arguments.jsonLines);
  std::map<std::string, Tally> tallies;
  std::uint64_t passed = 0, failed = 0;
  const Stopwatch watch;
  for (std::uint64_t seed = arguments.seedFrom; seed < arguments.seedFrom + arguments.count; ++seed) {
    const RandomScene random = randomScene(seed, arguments.kind, arguments.size);
    CompareOptions options;
    options.seed = seed;
    const SceneComparison found = compareScene(*context, random, options);
    if (lines.is_open()) lines << describe(seed, random, found).dump() << std::endl;
    tallies["base"].rms.push_back(found.render.rms);
    tallies["fine"].rms.push_back(found.fineRender.rms);
    tallies["depth"].rms.push_back(found.depth);
    if (random.scene.model == Model::emission) {
      tallies["base, slabs alone"].rms.push_back(found.slabs.rms);
      tallies["fine, slabs alone"].rms.push_back(found.fineSlabs.rms);
      tallies["reference"].rms.push_back(found.reference.rms);
    }
    for (const VariantDistance& variant : found.variants) tallies[variant.name].rms.push_back(variant.from.rms);
    for (const std::string& failure : found.failures) ++tallies[failure.substr(0, failure.find(':'))].failed;
    ++(found.failures.empty() ? passed : failed);
    if (!found.failures.empty() || arguments.verbose) {
      std::cout << seed << " " << random.description;
      for (const std::string& failure : found.failures) std::cout << " | " << failure;
      std::cout << std::endl;
    }
    if ((arguments.keepAll || !found.failures.empty()) && !arguments.keep.empty())
      keep(arguments.keep / std::to_string(seed), random, found);
  }
  std::cout << watch.elapsedMs() / 1000
            << " s. RMSE from the reference (base, fine), of the reference from slabs without "
            << "bricks, of depths, in voxels (depth), from the scene's own "
            << "picture (the others):\n";
  for (const auto& [name, tally] : tallies)
    std::cout << name << ": " << (tally.rms.empty() ? "" : distribution(tally.rms) + ", ") << tally.rms.size()
              << " scenes, " << tally.failed << " failed\n";
  std::cout << passed << " passed, " << failed << " failed\n";
  return failed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace umbrick

int main(int count, char** words) {
  try {
    const std::optional<umbrick::Arguments> arguments = umbrick::parse({words + 1, words + count});
    if (arguments) return umbrick::run(*arguments);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  std::cerr << umbrick::kUsage;
  return 2;
}
