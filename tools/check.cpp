// umbrick check tells whether bricks change anything: it measures the invariants of the renderer on a volume.
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "opened_scene.h"
#include "scene_options.h"
#include "umbrick/check/invariants.h"
#include "umbrick/core/error.h"
#include "umbrick/render/volume.h"

namespace umbrick::tools {
namespace {

struct CheckCommand {
  std::shared_ptr<SceneOptions> scene;
  CheckOptions check;
  std::string backend = "auto";
  bool json = false;
};

// Prints three digits, which are enough to compare a value with its limit.
std::string printNumber(double number) {
  char text[32];
  std::snprintf(text, sizeof text, number == std::floor(number) && number < 1e9 ? "%.0f" : "%.2e", number);
  return text;
}

void printTable(const std::vector<InvariantResult>& results) {
  std::size_t name = 0, measured = 0;
  for (const InvariantResult& result : results) {
    name = std::max(name, result.name.size());
    measured = std::max(measured, result.measured.size());
  }
  const auto row = [&](const std::string& number, const std::string& what, const std::string& how,
                       const std::string& value, const std::string& limit, const std::string& verdict) {
    std::printf("%s  %-*s  %-*s  %9s  %9s  %s\n", number.c_str(), static_cast<int>(name), what.c_str(),
                static_cast<int>(measured), how.c_str(), value.c_str(), limit.c_str(), verdict.c_str());
  };
  row(" ", "invariant", "measured", "value", "limit", "");
  for (const InvariantResult& result : results) {
    row(std::to_string(result.invariant), result.name, result.measured,
        result.samples > 0 ? printNumber(result.value) : "-", result.samples > 0 ? printNumber(result.limit) : "-",
        !result.passed       ? "FAILED"
        : result.samples > 0 ? "ok"
                             : result.detail);
    if (!result.passed) std::printf("   %s\n", result.detail.c_str());
  }
}

void printJson(const std::vector<InvariantResult>& results, const ResolvedScene& scene, const GlContext& context,
               unsigned seed) {
  nlohmann::ordered_json json;
  json["renderer"] = context.description();
  json["seed"] = seed;
  json["passed"] = std::all_of(results.begin(), results.end(), [](const auto& result) { return result.passed; });
  // A number that is not finite has no place in JSON.
  const auto number = [](double x) {
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json("inf");
  };
  for (const InvariantResult& result : results)
    json["invariants"].push_back({{"invariant", result.invariant},
                                  {"name", result.name},
                                  {"measured", result.measured},
                                  {"value", number(result.value)},
                                  {"limit", number(result.limit)},
                                  {"limit_from", result.limitFrom},
                                  {"samples", result.samples},
                                  {"excluded", result.excluded},
                                  {"passed", result.passed},
                                  {"detail", result.detail}});
  json["scene"] = nlohmann::ordered_json::parse(printScene(scene));
  std::cout << json.dump(2) << '\n';
}

int check(const CheckCommand& command) {
  for (const int edge : command.check.edges)
    if (edge % 8 != 0) throw UsageError("--edges: " + std::to_string(edge) + " is not a multiple of 8");
  Scene unopened = makeScene(*command.scene);
  if (!command.scene->has("size")) unopened.camera.width = unopened.camera.height = 256;
  const OpenedScene opened = openScene(*command.scene, unopened);
  const Scene& scene = opened.scene;
  const auto& volume = opened.volume;
  const ResolvedScene resolved = resolveScene(scene, volume->worldBounds(), volume->indexToWorld());
  const auto context = createContext(command.backend);
  std::cerr << opened.chosen;
  CheckOptions options = command.check;
  const bool terminal = isatty(STDERR_FILENO);
  if (terminal)
    options.progress = [](const std::string& step, double done) {
      std::fprintf(stderr, "\r\033[K%3.0f %%  %s", 100 * done, step.c_str());
    };
  const std::vector<InvariantResult> results = checkInvariants(*context, volume->grid(), resolved, options);
  if (terminal) std::fputs("\r\033[K", stderr);
  if (command.json)
    printJson(results, resolved, *context, options.seed);
  else
    printTable(results);
  return std::all_of(results.begin(), results.end(), [](const auto& result) { return result.passed; }) ? 0 : 1;
}

}  // namespace

Command addCheck(CLI::App& app) {
  const auto command = std::make_shared<CheckCommand>();
  CLI::App* sub = app.add_subcommand("check", "Measure on a volume that bricks and culling change nothing.");
  command->scene = addSceneOptions(*sub);
  addBackendOption(*sub, command->backend);
  // The check decides what is compared: emission and cone, with and without bricks and culling. So these
  // are no options.
  for (const char* option : {"--model", "--unbricked", "--no-culling"}) sub->remove_option(sub->get_option(option));
  sub->get_option("--size")->description("of the pictures, pixels [256x256]");
  const std::string group = "Check";
  sub->add_option("--edges", command->check.edges, "of bricks that are compared, voxels, multiples of 8")
      ->check(CLI::Range(8, 256))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--slices", command->check.probedSlices, "of each view whose pixels are looked at one by one")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--seed", command->check.seed, "of the choice of bricks whose voxels are read")
      ->capture_default_str()
      ->group(group);
  sub->add_flag("--json", command->json, "print JSON instead of a table")->group(group);
  return {sub, [command] { return check(*command); }};
}

}  // namespace umbrick::tools
