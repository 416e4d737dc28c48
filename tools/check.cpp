// umbrick check tells whether bricks change anything, in this renderer on a volume or in others by a kit.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check_kit.h"
#include "command.h"
#include "opened_scene.h"
#include "progress.h"
#include "scene_options.h"
#include "umbrick/check/invariants.h"
#include "umbrick/core/error.h"
#include "umbrick/render/volume.h"

namespace umbrick::tools {
namespace {

// Pictures are small: laws hold for each pixel, and brick faces cross pictures of any size.
constexpr int kPictureEdge = 96;

struct CheckCommand {
  std::shared_ptr<SceneOptions> scene;
  CheckOptions check;
  KitCommand kit;
  std::string backend = "auto", lightSweep = "auto";
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
    const auto left = [](const std::string& text, std::size_t width) {
      return text + std::string(width - std::min(width, text.size()), ' ') + "  ";
    };
    const auto right = [](const std::string& text) {
      constexpr std::size_t kWidth = 9;
      return std::string(kWidth - std::min(kWidth, text.size()), ' ') + text + "  ";
    };
    std::cout << number << "  " << left(what, name) << left(how, measured) << right(value) << right(limit) << verdict
              << '\n';
  };
  row(" ", "invariant", "measured", "value", "limit", "");
  for (const InvariantResult& result : results) {
    // What was not finished tells nothing, unless it has failed already.
    const bool failed = result.samples > 0 && !result.passed, known = result.samples > 0 && (result.complete || failed);
    row(std::to_string(result.invariant), result.name, result.measured, known ? printNumber(result.value) : "-",
        known ? printNumber(result.limit) : "-",
        failed             ? "FAILED"
        : !result.complete ? (result.samples > 0 ? "not finished" : "not tried")
        : known            ? "ok"
                           : result.detail);
    if (failed) std::cout << "   " << result.detail << '\n';
  }
}

bool isComplete(const std::vector<InvariantResult>& results) {
  return std::all_of(results.begin(), results.end(), [](const auto& result) { return result.complete; });
}

bool havePassed(const std::vector<InvariantResult>& results) {
  return isComplete(results) &&
         std::all_of(results.begin(), results.end(), [](const auto& result) { return result.passed; });
}

void printJson(const std::vector<InvariantResult>& results, const ResolvedScene& scene, const GlContext& context,
               unsigned seed) {
  nlohmann::ordered_json json;
  json["renderer"] = context.description();
  json["seed"] = seed;
  json["passed"] = havePassed(results);
  json["complete"] = isComplete(results);
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
                                  {"complete", result.complete},
                                  {"detail", result.detail}});
  json["scene"] = nlohmann::ordered_json::parse(printScene(scene));
  std::cout << json.dump(2) << '\n';
}

// Returns the scene of the emission's pictures, or that of the cone's: each has the sampling that umbrick render would
// give it.
Scene makeSceneOf(Model model, const SceneOptions& given) {
  SceneOptions options = given;
  if (model == Model::cone) {
    options.fields["model"] = [](Scene& scene) { scene.model = Model::cone; };
    options.tableSize.reset();  // of which emission has told already
  } else {
    options.quality.reset();
  }
  Scene scene = makeScene(options);
  if (!options.has("size")) scene.camera.width = scene.camera.height = kPictureEdge;
  return scene;
}

// Says how many laws a check that was stopped has measured.
void tellStopped(const std::vector<InvariantResult>& results) {
  const auto measured =
      std::count_if(results.begin(), results.end(), [](const auto& result) { return result.complete; });
  std::cerr << "umbrick: interrupted: " << measured << " of " << results.size()
            << " invariants are measured, the rest is not\n";
}

// Returns the case of the volume that is given, or the built-in ones.
std::vector<KitCase> casesFor(const CheckCommand& command) {
  const SceneOptions& given = *command.scene;
  if (given.input.empty()) return hardCases();
  refuseBackdrop(given);
  StopRequest stop;
  ProgressBar bar("loading " + given.input.filename().string());
  const OpenedScene opened =
      openScene(given, makeSceneOf(Model::emission, given), showShare(bar, stop, "interrupted; nothing was written"));
  bar.clear();
  KitCase made = kitCaseOf(given.input.stem().string(), opened.volume->grid(), opened.volume->resolve(opened.scene));
  std::cerr << opened.chosen;
  return {std::move(made)};
}

int workOnKit(const CLI::App& options, CheckCommand command) {
  checkKitOptions(options, command.kit, !command.scene->input.empty());
  if (!command.kit.against.empty()) return judgeAnswers(command.kit, command.json);
  command.kit.options.seed = command.check.seed;
  return writeKit(command.kit, [&] { return casesFor(command); });
}

int check(const CheckCommand& command) {
  if (command.scene->input.empty()) throw UsageError("input is required, but for --export and --against");
  for (const int edge : command.check.edges)
    if (edge % 8 != 0) throw UsageError("--edges: " + std::to_string(edge) + " is not a multiple of 8");
  refuseBackdrop(*command.scene);
  StopRequest stop;
  ProgressBar bar("loading " + command.scene->input.filename().string());
  const OpenedScene opened = openScene(*command.scene, makeSceneOf(Model::emission, *command.scene),
                                       showShare(bar, stop, "interrupted before anything was checked"));
  const auto& volume = opened.volume;
  const auto resolve = [&](const Scene& scene) {
    return resolveScene(scene, volume->worldBounds(), volume->indexToWorld());
  };
  const ResolvedScene resolved = resolve(opened.scene);
  CheckOptions options = command.check;
  const Scene lit = makeSceneOf(Model::cone, *command.scene);
  Scene cone = opened.scene;
  cone.sampling = lit.sampling;
  cone.spacingUnit = lit.spacingUnit;
  cone.occlusion = lit.occlusion;
  options.cone = resolve(cone);
  options.lightSweep = parseName(kLightSweeps, command.lightSweep, "--light-sweep");
  const auto context = createContext(command.backend);
  bar.clear();
  std::cerr << opened.chosen;
  bar.begin("check");
  stop.keepParts();
  options.progress = [&](const std::string& step, double done) {
    bar.show(done, step);
    return !stop.requested();
  };
  const std::vector<InvariantResult> results = checkInvariants(*context, volume->grid(), resolved, options);
  bar.clear();
  if (command.json)
    printJson(results, resolved, *context, options.seed);
  else
    printTable(results);
  if (!isComplete(results)) tellStopped(results);
  return havePassed(results) ? 0 : 1;
}

}  // namespace

Command addCheck(CLI::App& app) {
  const auto command = std::make_shared<CheckCommand>();
  CLI::App* sub = app.add_subcommand(
      "check", "Measure on a volume that bricks and culling change nothing and that techniques agree.");
  command->scene = addSceneOptions(*sub);
  // A kit has cases of its own.
  sub->get_option("input")->required(false);
  addBackendOption(*sub, command->backend);
  addLightSweepOption(*sub, command->lightSweep);
  // The check decides what is compared: emission and cone, with and without bricks and culling. So these
  // are no options.
  for (const char* option : {"--model", "--unbricked", "--no-culling", "--technique"})
    sub->remove_option(sub->get_option(option));
  sub->get_option("--size")->description("of the pictures, pixels [" + std::to_string(kPictureEdge) + "x" +
                                         std::to_string(kPictureEdge) + "]");
  const std::string group = "Check";
  sub->add_option("--edges", command->check.edges, "of bricks that are compared, voxels, multiples of 8")
      ->check(CLI::Range(8, 256))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--slices", command->check.probedSlices, "of each view whose pixels are looked at one by one")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--seed", command->check.seed,
                  "of the choice of bricks whose voxels are read, and of the points of a kit")
      ->capture_default_str()
      ->group(group);
  sub->add_flag("--json", command->json, "print JSON instead of a table")->group(group);
  addKitOptions(*sub, command->kit);
  return {sub, [command, sub] { return command->kit.asked() ? workOnKit(*sub, *command) : check(*command); }};
}

}  // namespace umbrick::tools
