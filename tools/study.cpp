// umbrick study tells what accuracy costs on a scene, as a table, plots and a page.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "opened_scene.h"
#include "output_option.h"
#include "progress.h"
#include "scene_options.h"
#include "study_page/gnuplot.h"
#include "study_page/page.h"
#include "study_page/pictures.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "validators.h"

namespace umbrick::tools {
namespace {
constexpr long double kDegree = 3.14159265358979323846 / 180.0L;

struct StudyCommand {
  std::shared_ptr<SceneOptions> scene;
  std::filesystem::path folder, earlier;
  std::string backend = "auto";
  bool quick = false, techniques = false, force = false;
  std::vector<std::string> methods, bits;
  std::vector<int> slices, segments, sizes;
  std::vector<double> thetas, scales;
  std::map<std::string, std::vector<int>> details;  // by name of the detail
  std::optional<int> repeats, directions;
  std::optional<double> tolerance;
};

// Parses "32", or "32/16": eye buffer, occlusion buffer.
BufferBits parseBits(const std::string& text) {
  BufferBits bits;
  int used = 0;
  const int count = std::sscanf(text.c_str(), "%d%n/%d%n", &bits.eye, &used, &bits.occlusion, &used);
  if (count < 1 || used != static_cast<int>(text.size()))
    throw UsageError("--bits: expected BITS or EYE/OCCLUSION, found '" + text + "'");
  if (count == 1) bits.occlusion = bits.eye;
  return bits;
}

template <class T>
void apply(const std::vector<T>& option, std::vector<T>& field) {
  if (!option.empty()) field = option;
}

StudySettings makeSettings(const StudyCommand& command, bool surfaces) {
  StudySettings settings = command.techniques ? techniqueSettings(command.quick, surfaces)
                           : command.quick    ? quickStudySettings()
                                              : StudySettings{};
  // The values of a quick study belong to its own methods.
  if (!command.methods.empty()) {
    settings.methods = command.methods;
    std::erase_if(settings.details, [&](const auto& detail) {
      return std::none_of(command.methods.begin(), command.methods.end(),
                          [&](const std::string& name) { return studyMethod(name).detail.name == detail.first; });
    });
  }
  for (const auto& [name, values] : command.details)
    if (!values.empty()) settings.details[name] = values;
  apply(command.slices, settings.slices);
  apply(command.segments, settings.segments);
  apply(command.sizes, settings.sizes);
  if (!command.scales.empty()) settings.scales = command.scales;
  if (!command.bits.empty()) {
    settings.bits.clear();
    for (const std::string& text : command.bits) settings.bits.push_back(parseBits(text));
  }
  if (!command.thetas.empty()) {
    settings.thetas.clear();
    for (const double degrees : command.thetas) settings.thetas.push_back(static_cast<double>(degrees * kDegree));
  }
  settings.repeats = command.repeats.value_or(settings.repeats);
  settings.directions = command.directions.value_or(settings.directions);
  settings.tolerance = command.tolerance.value_or(settings.tolerance);
  return settings;
}

// Refuses what is no folder, and files of an earlier run that are not to be replaced.
void checkFolder(const StudyCommand& command) {
  if (command.folder == "-") throw UsageError("--output: expected a folder, since a study is many files, found -");
  for (const char* file : {"study.json", "study.csv", "scene.json", "index.html"}) {
    std::filesystem::path path = command.folder / file;
    std::error_code none;
    if (std::filesystem::exists(path, none)) prepareOutput(path, command.force);
  }
}

int study(const StudyCommand& command) {
  checkFolder(command);
  refuseBackdrop(*command.scene);
  const Scene unopened = makeScene(*command.scene);
  const bool surfaces = traitsOf(unopened.mode).surfaces || !unopened.surfaces.empty();
  StudySettings settings = makeSettings(command, surfaces);
  if (command.techniques && command.methods.empty() && !surfaces)
    std::cerr << "--techniques: without --mode isosurface --iso V there are no pictures of isosurface and hybrid\n";
  if (command.techniques && settings.thetas.empty()) settings.thetas = {unopened.occlusion.aperture};
  planStudy(settings, unopened.occlusion.aperture);  // refuses wrong settings before a volume is loaded
  StopRequest stop;
  ProgressBar bar("loading " + command.scene->input.filename().string());
  const OpenedScene opened =
      openScene(*command.scene, unopened, showShare(bar, stop, "interrupted before anything was measured"));
  bar.clear();
  Scene scene = opened.scene;
  showAs(StudyLook::medium, scene);  // methods say what they show
  const Volume& volume = *opened.volume;
  const ResolvedScene resolved = volume.resolve(scene);
  const auto context = createContext(command.backend);
  std::cerr << opened.chosen;
  const PageFolder folder(command.folder);
  StudyOptions options;
  options.earlier = command.earlier;
  options.plotter = gnuplotVersion();  // fails before anything is measured that could not be plotted later
  options.picture = [&](const StudyPicture& p) { writePictures(folder, p, resolved.ambient); };
  const StudyOutcome outcome = [&] {
    bar.begin("study");
    stop.keepParts();
    options.progress = [&](const StudyProgress& p) {
      bar.show(p.share, p.step);
      return !stop.requested();
    };
    StudyOutcome measured = runStudy(*context, volume.grid(), resolved, settings, command.folder, options);
    writePage(measured.study, folder);
    bar.clear();
    return measured;
  }();
  warnOfNonFinite(scene, outcome.nonFiniteVoxels);
  for (const std::filesystem::path& path : {folder.page(), outcome.table, outcome.record})
    std::cout << shownName(path) << '\n';
  if (outcome.study.complete()) return 0;
  std::cerr << "umbrick: stopped after " << outcome.study.cases.size() << " of " << outcome.study.plan.cases.size()
            << " cases; the same command goes on\n";
  return 1;
}

std::string methodNames() {
  std::string text;
  for (const StudyMethod& method : studyMethods())
    text += (text.empty() ? "" : ", ") + method.name + (method.usual ? "" : " (not unless named)");
  return text;
}

std::string printedList(const std::vector<int>& values) {
  std::string text;
  for (const int value : values) {
    if (!text.empty()) text += ' ';
    text += std::to_string(value);
  }
  return text;
}

// Returns the slices of the methods that are in a study by default, or in a quick one: "64 128 (emission, dos),
// 16 32 (ordinates)".
std::string slicesOfMethods(bool quick) {
  std::vector<std::pair<std::string, std::string>> lists;  // slices, methods
  for (const StudyMethod& method : studyMethods()) {
    if (!(quick ? method.quick : method.usual)) continue;
    const std::string slices = printedList(quick ? method.quickSlices : method.slices);
    if (lists.empty() || lists.back().first != slices)
      lists.emplace_back(slices, method.name);
    else
      lists.back().second += ", " + method.name;
  }
  std::string text;
  for (const auto& [slices, methods] : lists) text += (text.empty() ? "" : "; ") + slices + " (" + methods + ")";
  return text;
}

void addSweeps(CLI::App& sub, StudyCommand& c) {
  const StudySettings full, quick = quickStudySettings();
  const std::string group = "Sweeps";
  const auto defaults = [](const std::string& usual, const std::string& small) {
    return " [" + usual + "; quick: " + small + "]";
  };
  std::string quickMethods;
  for (const std::string& name : quick.methods) quickMethods += " " + name;
  sub.add_option("--methods", c.methods, methodNames() + " [all that are not marked; quick:" + quickMethods + "]")
      ->type_name(kMethodType)
      ->group(group);
  sub.add_option(
         "--slices", c.slices,
         "through the visible extent along the view axis" + defaults(slicesOfMethods(false), slicesOfMethods(true)))
      ->group(group);
  // There is one option per name, which several methods may share.
  for (const StudyMethod& method : studyMethods()) {
    const StudyMethod::Detail& detail = method.detail;
    if (detail.name.empty() || c.details.contains(detail.name)) continue;
    sub.add_option(
           "--" + detail.plural, c.details[detail.name],
           detail.symbol + ": " + detail.meaning + defaults(printedList(detail.full), printedList(detail.quick)))
        ->group(group);
  }
  sub.add_option("--bits", c.bits,
                 "of the buffers: 16 or 32 for both, or EYE/OCCLUSION [32 32/16 16/32 16; quick: 32 16]")
      ->group(group);
  sub.add_option("--segments", c.segments,
                 "of a slab along the ray, 1 to 8" + defaults(printedList(full.segments), printedList(quick.segments)))
      ->group(group);
  sub.add_option("--sizes", c.sizes,
                 "height of the picture and of both buffers, pixels; the width follows from the scene's --size" +
                     defaults(printedList(full.sizes), printedList(quick.sizes)))
      ->group(group);
  std::string scales;
  for (const double scale : kUsualScales) scales += (scales.empty() ? "" : " ") + CLI::detail::to_string(scale);
  sub.add_option("--scales", c.scales,
                 "of the windows of ordinates: texels per voxel edge, 0.015625 to 64, beside the automatic scale [" +
                     scales + "; quick: none]")
      ->group(group);
  sub.add_option("--thetas", c.thetas,
                 "half-angles of the cone, degrees, in [0, 90) [the scene's and 80; of --techniques the scene's]")
      ->group(group);
}

void addMeasuring(CLI::App& sub, StudyCommand& c) {
  const StudySettings full, quick = quickStudySettings();
  const std::string group = "Measuring";
  sub.add_option("--repeats", c.repeats,
                 "timed turns of baseline and case, at least [" + std::to_string(full.repeats) +
                     "; quick: " + std::to_string(quick.repeats) + "]")
      ->check(CLI::Range(1, 1000))
      ->group(group);
  sub.add_option("--reference-directions", c.directions,
                 "of the references: about so many over the cone or the sphere [" + std::to_string(full.directions) +
                     "; quick: " + std::to_string(quick.directions) + "]")
      ->check(CLI::Range(2, 1000000))
      ->group(group);
  sub.add_option("--reference-tolerance", c.tolerance,
                 "of the references: of the radiance of a stretch of the ray, in (0, 1] [0.001; quick: 0.004]")
      ->check(CLI::Range(1e-9, 1.0))
      ->group(group);
}

}  // namespace

Command addStudy(CLI::App& app) {
  const auto command = std::make_shared<StudyCommand>();
  CLI::App* sub = app.add_subcommand(
      "study",
      "Measure speed against error. Around a base point (the middle of the slices and of the detail, the most bits, "
      "fewest segments, largest size, the scene's theta) slices x detail, slices x theta and each other list alone are "
      "swept; the "
      "folder gets index.html, study.csv and study.json. A stopped study goes on when it is started again.");
  command->scene = addSceneOptions(*sub);
  addBackendOption(*sub, command->backend);
  // What the study sweeps is no option of the scene, and errors are measured without background radiance.
  for (const char* option : {"--model", "--method", "--quality", "--theta", "--footprint", "--directions",
                             "--occlusion-scale", "--light-spacing", "--algorithm", "--passes", "--occlusion-bits",
                             "--eye-bits", "--spacing", "--spacing-unit", "--segments", "--background", "--technique"})
    sub->remove_option(sub->get_option(option));
  sub->get_option("--size")->description("its shape is that of the study's pictures [512x512]");
  sub->add_option("-o,--output", command->folder, "folder of the report: new, empty, or of the same study")
      ->required()
      ->group("Output");
  sub->add_option("--compare", command->earlier,
                  "study.json of an earlier study of this scene on this machine: the page shows its Pareto fronts, too")
      ->group("Output");
  addForceOption(*sub, command->force)->group("Output");
  sub->add_flag("--quick", command->quick, "a small study, about two minutes on two cores for the bundled CT");
  sub->add_flag("--techniques", command->techniques,
                "all techniques beside each other, in all modes (isosurface and hybrid with --mode isosurface --iso "
                "V): the page says "
                "which one is the fastest for which error");
  addSweeps(*sub, *command);
  addMeasuring(*sub, *command);
  return {sub, [command] { return study(*command); }};
}

}  // namespace umbrick::tools
