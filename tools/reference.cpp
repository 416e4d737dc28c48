// umbrick reference makes the picture that a renderer should make, integrated on the CPU.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/reference/reference.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "mode_options.h"
#include "opened_scene.h"
#include "picture_output.h"
#include "progress.h"
#include "scene_options.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/render/picture_notes.h"
#include "umbrick/scene/capabilities.h"
#include "validators.h"

namespace umbrick::tools {
namespace {

struct ReferenceCommand {
  std::shared_ptr<SceneOptions> scene;
  std::shared_ptr<PictureOutput> output;
  ReferenceOptions reference;
  std::string integrator = "quadrature";
  int samples = 0;  // 0: not given
  bool noSkipping = false, strict = false;
};

std::string describe(const ReferenceOptions& options) {
  nlohmann::ordered_json json;
  if (options.integrator == Integrator::quadrature) {
    json["integrator"] = nameOf(kIntegrators, options.integrator);
    if (options.step > 0)
      json["step_voxels"] = options.step;
    else
      json["tolerance"] = options.tolerance;
    json["directions"] = options.directions;
  } else {
    json["integrator"] = nameOf(kIntegrators, options.integrator);
    json["samples"] = options.samples;
    if (options.standardError > 0) json["standard_error"] = options.standardError;
    json["seed"] = options.seed;
  }
  return json.dump();
}

nlohmann::ordered_json printStats(const ReferenceCommand& command, const ResolvedScene& scene, double loadMs,
                                  const ReferencePicture& picture) {
  const ReferenceStats& stats = picture.stats;
  nlohmann::ordered_json json;
  json["reference"] = nlohmann::ordered_json::parse(describe(command.reference));
  json["size"] = {scene.camera.width, scene.camera.height};
  json["complete"] = picture.complete;
  json["share_done"] = stats.share;
  json["time_ms"] = {{"load", loadMs}, {"field", stats.fieldMs}, {"integrate", stats.integrateMs}};
  json["eye_rays"] = stats.eyeRays;
  json["light_rays"] = stats.lightRays;
  json["cells"] = stats.cells;
  json["samples"] = stats.samples;
  json["unconverged_pixels"] = stats.unconvergedPixels;
  json["blocks"] = stats.blocks;
  json["non_finite_voxels"] = stats.nonFiniteVoxels;
  json["peak_memory_bytes"] = peakMemoryBytes();
  json["scene"] = nlohmann::ordered_json::parse(printScene(scene));
  return json;
}

int runReference(ReferenceCommand& command) {
  PictureOutput& output = *command.output;
  checkOutputs(output);
  StopRequest stop;
  ProgressBar bar("loading " + command.scene->input.filename().string());
  // Monte Carlo integrates no light of a grid, so that none is looked for.
  const SceneDefaults defaults{.model = Model::cone,
                               .emission = command.integrator == nameOf(kIntegrators, Integrator::quadrature)};
  const OpenedScene opened = openScene(*command.scene, makeScene(*command.scene, defaults),
                                       showShare(bar, stop, "interrupted; nothing was written"));
  const Scene& scene = opened.scene;
  const Volume& volume = *opened.volume;
  const ResolvedScene resolved = volume.resolve(scene);
  prepareLook(output, command.scene->backdrop, resolved, unitsOf(volume.grid()));
  ReferenceOptions& options = command.reference;
  options.integrator = parseName(kIntegrators, command.integrator, "--integrator");
  options.skipEmpty = !command.noSkipping;
  // If no number of paths is given, as many are traced as the standard error needs.
  if (options.standardError > 0 && command.samples == 0) options.samples = 1'000'000'000;
  if (command.samples > 0) options.samples = command.samples;
  // Of paths that nobody has counted there are enough for each sample of a pixel to have two.
  if (command.samples == 0) options.samples = std::max(options.samples, 2 * resolved.sampling.pixelSamples);
  bar.clear();
  std::cerr << opened.chosen;
  bar.begin("reference");
  stop.keepParts();
  options.progress = [&](double share) {
    bar.show(share);
    return !stop.requested();
  };
  tellUnusedByMode(*command.scene, resolved, output.layers);
  const ReferencePicture picture = renderReference(volume.grid(), resolved, options);
  bar.clear();
  warnOfNonFinite(scene, picture.stats.nonFiniteVoxels);
  std::vector<ImageLayer> layers{{"", picture.colour}};
  if (options.integrator == Integrator::monteCarlo) layers.push_back({"standardError", picture.standardError});
  if (output.layers && !traitsOf(resolved.mode).projection) {
    layers.push_back({"V", picture.visibility});
    layers.push_back({"Z", picture.depth});
  }
  if (output.layers || traitsOf(resolved.mode).projection)
    layers.insert(layers.end(), picture.layers.begin(), picture.layers.end());
  writeOutputs(output, layers,
               {{"umbrick.scene", printScene(resolved)},
                {"umbrick.renderer", "reference"},
                {"umbrick.reference", describe(options)},
                {"umbrick.filter", pixelFilter(resolved.sampling.pixelSamples)},
                {"umbrick.complete", picture.complete ? "true" : "false"},
                {"umbrick.version", UMBRICK_VERSION}});
  printOutputs(output);
  if (!output.stats.empty())
    writeTextFile(output.stats, printStats(command, resolved, volume.loadMs(), picture).dump(2) + "\n");
  if (picture.stats.unconvergedPixels > 0)
    std::cerr << "umbrick: " << picture.stats.unconvergedPixels << " pixels took all " << options.samples
              << " samples and have a standard error above " << options.standardError << '\n';
  const auto empty =
      picture.complete ? describeEmptyPicture(picture.colour, resolved, volume, *command.scene) : std::nullopt;
  if (empty) std::cerr << *empty << '\n';
  if (picture.complete) return empty && command.strict ? 1 : 0;
  std::cerr << "umbrick: stopped; the picture holds " << static_cast<int>(100 * picture.stats.share)
            << " % of its pixels, the rest is 0\n";
  return 1;
}

}  // namespace

Command addReference(CLI::App& app) {
  const auto command = std::make_shared<ReferenceCommand>();
  CLI::App* sub = app.add_subcommand("reference", "Integrate the same model on the CPU, as what to compare with.");
  // Here samples are the paths of a pixel, and those that its area is averaged over have a longer name.
  command->scene = addSceneOptions(*sub, {{"samples", "pixel-samples"}});
  command->output =
      addPictureOutput(*sub, "float", "V (visibility weighted by opacity) and Z (mean depth, world units)");
  ReferenceOptions& o = command->reference;
  const std::string group = "Integration";
  // A reference has directions of its own, not the few that a scene gives to the slices.
  for (const char* option : {"--directions", "--technique"}) sub->remove_option(sub->get_option(option));
  sub->add_option("--directions", o.directions, "quadrature, K: about so many over the cone, the sphere or the lights")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--integrator", command->integrator,
                  "quadrature (deterministic), or monte-carlo, which adds the layer standardError to an EXR")
      ->check(CLI::IsMember(listNames(kIntegrators)))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--tolerance", o.tolerance, "quadrature: of the radiance of a stretch of the ray, in (0, 1]")
      ->check(numberIn(1e-9, 1.0, "1e-9 to 1"))
      ->capture_default_str()
      ->group(group);
  sub->add_option("--step", o.step,
                  "quadrature: distance of the points where occlusion is computed, voxels (shortest "
                  "edge); 0: as --tolerance asks for")
      ->check(nonNegativeNumber())
      ->capture_default_str()
      ->group(group);
  sub->add_option("--samples", command->samples,
                  "monte-carlo: paths per pixel, at most, dealt to its --pixel-samples [256; with --standard-error as "
                  "many as it "
                  "takes]")
      ->check(CLI::Range(2, 1000000000))
      ->group(group);
  sub->add_option("--standard-error", o.standardError,
                  "monte-carlo: a pixel is done at this estimated standard error; 0: takes all samples")
      ->check(nonNegativeNumber())
      ->capture_default_str()
      ->group(group);
  sub->add_option("--seed", o.seed, "monte-carlo: of the random numbers")
      ->check(nonNegativeNumber())
      ->capture_default_str()
      ->group(group);
  sub->add_flag("--no-skipping", command->noSkipping, "visit empty space, too: slower, the same picture")->group(group);
  sub->add_option("--threads", o.threads, "0: one per core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str()
      ->group(group);
  addStrictOption(*sub, command->strict);
  return {sub, [command] { return runReference(*command); }};
}

}  // namespace umbrick::tools
