// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <iostream>
#include <numbers>
#include <string>
#include <utility>

#include "command.h"
#include "mode_options.h"
#include "option_words.h"
#include "stop_request.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "umbrick/render/engine.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick::tools {
namespace {
constexpr double kRadians = std::numbers::pi / 180;

glm::dvec3 toVector(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// Parses a size such as "1024x768".
glm::ivec2 parseSize(const std::string& text) {
  glm::ivec2 size(0);
  int used = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &size.x, &size.y, &used) != 2 || used != static_cast<int>(text.size()))
    throw UsageError("--size: expected WIDTHxHEIGHT in pixels, found '" + text + "'");
  return size;
}

// A background as the command line gives it.
struct NamedColour {
  std::optional<glm::dvec3> radiance;
  Backdrop backdrop = Backdrop::none;
};

// Parses three numbers, or a name three times over, see spellOutBackground.
NamedColour parseColour(const std::string& option, const std::vector<std::string>& words) {
  if (words[0] == words[1] && words[1] == words[2]) {
    if (words[0] == "white") return {glm::dvec3(1)};
    if (words[0] == "black") return {glm::dvec3(0)};
    if (words[0] == "gradient") return {std::nullopt, Backdrop::gradient};
  }
  glm::dvec3 colour(0);
  for (int i = 0; i < 3; ++i) {
    const std::string& word = words[static_cast<std::size_t>(i)];
    if (!CLI::detail::lexical_cast(word, colour[i]))
      throw UsageError(option + ": expected white, black, gradient or three numbers, found '" + word + "'");
  }
  return {colour};
}

// --- the table of fields as options ---

// Returns a place of the field's kind, in a scene that has it.
FieldPlace examplePlace(const SceneField& field, Scene& orbited, Scene& placed) {
  placed.orbit.reset();
  const FieldPlace place = field.place(orbited);
  return std::holds_alternative<std::monostate>(place) ? field.place(placed) : place;
}

// Adds options that set a field to a value of its kind.
class FieldOption {
 public:
  FieldOption(CLI::App& command, SceneOptions& options, const SceneField& field)
      : command_(command), options_(options), field_(field), name_(options.nameOf(field.option)) {}

  CLI::Option* operator()(std::monostate) const { return nullptr; }
  CLI::Option* operator()(const double*) const {
    return add<double>([](const FieldPlace& place, double value) { *std::get<double*>(place) = value; });
  }
  CLI::Option* operator()(const Angle&) const {
    return add<double>(
        [](const FieldPlace& place, double value) { *std::get<Angle>(place).radians = value * kRadians; });
  }
  CLI::Option* operator()(const int*) const {
    return add<int>([](const FieldPlace& place, int value) { *std::get<int*>(place) = value; });
  }
  CLI::Option* operator()(const std::uint64_t*) const {
    return add<std::uint64_t>(
        [](const FieldPlace& place, std::uint64_t value) { *std::get<std::uint64_t*>(place) = value; });
  }
  CLI::Option* operator()(const bool* usual) const {
    const bool other = !*usual;
    return command_.add_flag_callback(
        name_, setter([other](const FieldPlace& place) { *std::get<bool*>(place) = other; }), helpText(field_));
  }
  CLI::Option* operator()(const Choice& choice) const {
    return add<std::string>(
               [](const FieldPlace& place, const std::string& value) { std::get<Choice>(place).set(value); })
        ->check(CLI::IsMember(choice.names()));
  }
  CLI::Option* operator()(const glm::dvec2*) const {
    return add<std::vector<double>>([](const FieldPlace& place, const std::vector<double>& value) {
             *std::get<glm::dvec2*>(place) = {value[0], value[1]};
           })
        ->expected(2);
  }
  CLI::Option* operator()(const glm::dvec3*) const {
    return add<std::vector<double>>([](const FieldPlace& place, const std::vector<double>& value) {
             *std::get<glm::dvec3*>(place) = toVector(value);
           })
        ->expected(3);
  }
  CLI::Option* operator()(const std::optional<glm::dvec3>*) const {
    return command_
        .add_option_function<std::vector<std::string>>(
            name_,
            [this_ = *this](const std::vector<std::string>& words) {
              const NamedColour colour = parseColour(this_.name_, words);
              this_.options_.backdrop = colour.backdrop;
              this_.setter([colour](const FieldPlace& place) {
                *std::get<std::optional<glm::dvec3>*>(place) = colour.radiance;
              })();
            },
            helpText(field_) + "; or a name: white, black, or gradient (in a PNG alone, behind what is transparent)")
        ->type_name("FLOAT")
        ->expected(3)
        ->allow_extra_args(false);
  }
  CLI::Option* operator()(const PixelSize&) const {
    return add<std::string>([](const FieldPlace& place, const std::string& value) {
      const glm::ivec2 size = parseSize(value);
      const PixelSize& target = std::get<PixelSize>(place);
      *target.width = size.x;
      *target.height = size.y;
    });
  }

 private:
  // Remembers what the option says until the scene is read.
  template <class Assign>
  std::function<void()> setter(Assign assign) const {
    return [this_ = *this, assign] {
      this_.options_.fields[std::string(this_.field_.option)] = [this_, assign](Scene& scene) {
        assign(this_.field_.place(scene));
      };
    };
  }
  template <class Value, class Assign>
  CLI::Option* add(Assign assign) const {
    return command_.add_option_function<Value>(
        name_,
        [this_ = *this, assign](const Value& value) {
          this_.setter([assign, value](const FieldPlace& place) { assign(place, value); })();
        },
        helpText(field_));
  }

  CLI::App& command_;
  SceneOptions& options_;
  const SceneField& field_;
  std::string name_;
};

void addFieldOptions(CLI::App& command, SceneOptions& options, std::string_view group) {
  Scene orbited, placed;
  for (const SceneField& field : sceneFields())
    if (field.group == group && !field.option.empty())
      std::visit(FieldOption(command, options, field), examplePlace(field, orbited, placed))
          ->group(std::string(field.group));
}

// Reads one number, the distance of slices, or three, the spacing of voxels.
void readSpacing(const std::string& text, SceneOptions& options) {
  const auto numbers = parseNumbers(text);
  if (numbers && numbers->size() == 3)
    options.volume.spacing = *numbers;
  else if (numbers && numbers->size() == 1)
    options.fields["spacing"] = [distance = numbers->front()](Scene& scene) { scene.sampling.spacing = distance; };
  else
    throw CLI::ValidationError("--spacing", "expected a distance of slices, or three numbers, found '" + text + "'");
}

}  // namespace

std::vector<std::string> spellOutBackground(std::vector<std::string> arguments) {
  const auto isNumber = [](const std::string& word) {
    double number = 0;
    return CLI::detail::lexical_cast(word, number);
  };
  const std::string option = "--background";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].rfind(option + "=", 0) == 0) {
      arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1, arguments[i].substr(option.size() + 1));
      arguments[i] = option;
    }
    if (arguments[i] != option || i + 1 == arguments.size()) continue;
    const std::string word = arguments[i + 1];
    if (isNumber(word) || word.empty() || word[0] == '-') continue;
    arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1, 2, word);
  }
  return arguments;
}

void SceneOptions::take(const std::filesystem::path& file) {
  input = file;
  whole = file.extension() == ".json";
}

std::string SceneOptions::nameOf(std::string_view option) const {
  const auto other = renamed.find(option);
  return "--" + (other == renamed.end() ? std::string(option) : other->second);
}

std::shared_ptr<SceneOptions> addSceneOptions(CLI::App& command, const OptionNames& renamed) {
  const auto options = std::make_shared<SceneOptions>();
  SceneOptions& o = *options;
  o.renamed = renamed;
  command
      .add_option_function<std::filesystem::path>(
          "input", [&o](const std::filesystem::path& input) { o.take(input); },
          "a volume of any format that convert reads, a .vdb or .nvdb, numbered files (frame_%04d.nrrd: the "
          "first), or a .json scene")
      ->required();
  addVolumeOptions(command, o.volume);

  const std::string medium = "Medium";
  command
      .add_option("--tf", o.transfer,
                  "transfer function: a preset (umbrick tf list), a JSON file, or auto: one that fits the volume "
                  "[that of the scene, or auto]")
      ->type_name(kPresetOrPath)
      ->group(medium);
  command.add_option("--window", o.window, "stretch the transfer function to these values, grid units")
      ->expected(2)
      ->group(medium);
  command.add_option("--sigma-scale", o.sigmaScale, "multiply the extinction [1]")->group(medium);
  addFieldOptions(command, o, medium);

  const std::string emission = "Emission";
  std::string names;
  for (const std::string_view name : emissionGridNames()) names.append(names.empty() ? "" : ", ").append(name);
  command
      .add_option("--emission-grid", o.volume.emissionGrid,
                  "of a file of grids: the one that emits light beside the one that is shown, none, or auto: the first "
                  "that is above 0 somewhere of " +
                      names + " [render, reference and view without a transfer function: auto; else none]")
      ->group(emission);
  command
      .add_option(
          "--emission-tf", o.emissionTransfer,
          "what values of --emission-grid emit: a preset or a JSON file, whose albedo times sigma_t is radiance "
          "per world unit; makes --emission-kind table")
      ->type_name(kPresetOrPath)
      ->group(emission);
  addFieldOptions(command, o, emission);

  addFieldOptions(command, o, "Camera");
  command.add_flag("--orthographic", o.orthographic, "parallel view")->group("Camera");
  command
      .add_option("--view", o.view,
                  "by name: front, back, left, right, top, bottom; of a patient whose file states the anatomy also "
                  "anterior, posterior, superior, inferior, and left and right are the patient's own [azimuth 30, "
                  "elevation 15]")
      ->type_name(kViewType)
      ->group("Camera");
  command
      .add_option_function<std::string>(
          "--up",
          [&o](const std::string& up) {
            o.up = up;
            o.upward = parseNumbers(up);
          },
          "what is up: x, y, z, -x, -y, -z or auto (the patient's head; z for other scans; of a .vdb that other "
          "programs wrote mostly y); beside --eye also three numbers [auto; with --eye 0 0 1]")
      ->type_name(kAxisType)
      ->group("Camera");

  addFieldOptions(command, o, "Mode");
  addSurfaceOptions(command, o);

  addFieldOptions(command, o, "Mesh");
  addMeshOption(command, o);

  addFieldOptions(command, o, "Light");
  command
      .add_option("--quality", o.quality,
                  "draft, normal or high: a method with spacing, segments and directions that go together; options "
                  "that name one of them win [of a .vdb: normal]")
      ->check(CLI::IsMember(listNames(kQualities)))
      ->group("Light");

  addFieldOptions(command, o, "Sampling");
  // Three numbers are those that convert takes by the same name.
  command.remove_option(command.get_option("--spacing"));
  const SceneField& spacing = *findSceneField("spacing");
  command
      .add_option_function<std::string>(
          "--spacing", [&o](const std::string& text) { readSpacing(text, o); },
          helpText(spacing) + "; three numbers: of the voxels of a volume whose file states none")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group("Sampling");
  command
      .add_option("--table-size", o.tableSize,
                  "no effect: there is no table any more; kept so that earlier commands work")
      ->group("Sampling");

  const std::string clip = "Clipping";
  command.add_option("--clip-plane", o.clipPlanes, "a b c d: keep a x + b y + c z + d >= 0, world; may be repeated")
      ->type_size(4)
      ->group(clip);
  command.add_option("--clip-box", o.clipBox, "keep x0 y0 z0 x1 y1 z1, world")->expected(6)->group(clip);

  addFieldOptions(command, o, "Bricks");
  return options;
}

void addStrictOption(CLI::App& command, bool& strict) {
  command
      .add_flag("--strict", strict, "exit status 1 for a picture in which nothing is drawn, or every pixel is opaque")
      ->group("Output");
}

void addBackendOption(CLI::App& command, std::string& backend) {
  command.add_option("--backend", backend, "OpenGL: auto (OSMesa, else EGL), osmesa or egl")
      ->check(CLI::IsMember(listNames(kBackends)))
      ->capture_default_str();
}

void addEngineOption(CLI::App& command, std::string& engine) {
  command
      .add_option("--backend", engine,
                  "what draws: cpu (SIMD, by rays or shear-warp), osmesa or egl (OpenGL, by slices or rays), or auto: "
                  "a GPU through "
                  "EGL where there is one, else cpu, or OpenGL in software for what cpu cannot do")
      ->check(CLI::IsMember(listNames(kEngineKinds)))
      ->capture_default_str();
}

void addLightSweepOption(CLI::App& command, std::string& sweep) {
  command
      .add_option("--light-sweep", sweep,
                  "what computes light volumes that OpenGL draws: gl (compute shaders, from bricks that are resident), "
                  "cpu (SIMD), or auto: gl on a GPU, cpu where OpenGL runs in software; the light is the same")
      ->check(CLI::IsMember(listNames(kLightSweeps)))
      ->capture_default_str();
}

void ContextCloser::operator()(GlContext* context) const {
  if (!stopRequested()) delete context;
}

std::unique_ptr<GlContext, ContextCloser> createContext(const std::string& backend) {
  return std::unique_ptr<GlContext, ContextCloser>(
      createGlContext(parseName(kBackends, backend, "--backend")).release());
}

Scene makeScene(const SceneOptions& options, const SceneDefaults& defaults, bool frames) {
  Scene scene;
  if (options.whole)
    scene = readScene(options.input, options.volume.besideOnly);
  else
    scene.volume.file = options.input;
  applyVolumeOptions(options.volume, scene.volume);
  SceneDefaults wanted = defaults;
  if (options.volume.emissionGrid) wanted.emission = false;  // "none" is an answer, too
  std::vector<ReplacedKeys> replaced;
  scene = asUsage([&] { return askedScene(options, std::move(scene), wanted, &replaced); });
  for (const ReplacedKeys& keys : replaced)
    std::cerr << keys.option << " takes the place of the keys of " << keys.field << " in "
              << printable(options.input.string()) << '\n';
  if (options.tableSize)
    std::cerr << "--table-size has no effect any more: transfer functions are integrated exactly, without a table\n";
  if (!frames) tellFrameShown(options, scene);
  return scene;
}

void tellFrameShown(const SceneOptions& options, const Scene& scene) {
  if (scene.tracks.empty()) return;
  std::string fields;
  for (const SceneTrack& track : scene.tracks) fields += (fields.empty() ? "" : ", ") + track.field;
  std::cerr << printable(options.input.string()) << ": " << fields
            << " as at frame 0; umbrick render --count, or --frames of a sequence, follows the scene's keys\n";
}

void refuseBackdrop(const SceneOptions& options) {
  if (options.backdrop != Backdrop::none)
    throw UsageError("--background gradient: is of a PNG, which this command does not write");
}

void warnOfNonFinite(const Scene& scene, std::uint64_t voxels) {
  if (voxels > 0)
    std::cerr << printable(scene.volume.file.string()) << ": " << voxels
              << " voxels are not finite and count as background\n";
}

}  // namespace umbrick::tools
