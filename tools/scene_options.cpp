// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>

#include "command.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/progressive.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick::tools {
namespace {
constexpr double kRadians = 3.14159265358979323846 / 180;

template <class T, class U>
void apply(const std::optional<T>& option, U& field) {
  if (option) field = *option;
}

glm::dvec3 toVector(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// "1024x768"
void applySize(const std::string& text, Camera& camera) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &camera.width, &camera.height, &used) != 2 ||
      used != static_cast<int>(text.size()))
    throw UsageError("--size: expected WIDTHxHEIGHT in pixels, found '" + text + "'");
}

void applyCamera(const SceneOptions& options, Scene& scene) {
  Camera& camera = scene.camera;
  if (options.orthographic) camera.projection = Projection::orthographic;
  if (options.fov) camera.fov = *options.fov * kRadians;
  apply(options.nearDistance, camera.nearDistance);
  if (options.size) applySize(*options.size, camera);
  const bool angles = options.azimuth || options.elevation;
  if (options.eye && angles) throw UsageError("--eye and --azimuth, --elevation exclude each other");
  if (options.eye || (options.lookAt && !scene.orbit)) {
    if (scene.orbit && !options.lookAt) throw UsageError("--eye needs --look-at");
    if (scene.orbit) camera.up = {0, 0, 1};
    scene.orbit.reset();
  }
  if (scene.orbit && (options.lookAt || options.up || options.viewHeight))
    throw UsageError("--look-at, --up and --view-height need --eye");
  if (angles) {
    if (!scene.orbit) scene.orbit = Orbit{};
    if (options.azimuth) scene.orbit->azimuth = *options.azimuth * kRadians;
    if (options.elevation) scene.orbit->elevation = *options.elevation * kRadians;
  }
  if (options.eye) camera.eye = toVector(*options.eye);
  if (options.lookAt) camera.lookAt = toVector(*options.lookAt);
  if (options.up) camera.up = toVector(*options.up);
  apply(options.viewHeight, camera.viewHeight);
}

void applyTransfer(const SceneOptions& options, const DefaultTransfer& defaultTransfer, Scene& scene) {
  if (options.transfer) scene.transfer = loadTransferFunction(*options.transfer);
  if (!scene.transfer && defaultTransfer) scene.transfer = defaultTransfer(scene);
  if (!scene.transfer) throw UsageError("no transfer function: give --tf (a preset or a file) or a scene that has one");
  if (options.window) scene.transfer = scene.transfer->windowed((*options.window)[0], (*options.window)[1]);
  if (options.sigmaScale) scene.transfer = scene.transfer->scaled(*options.sigmaScale);
}

// What only the other method would look at says that the user expects that one.
void checkMethodOptions(const SceneOptions& options, Method method) {
  const std::pair<const char*, bool> given[] = {{"--footprint", options.footprint.has_value()},
                                                {"--algorithm", options.algorithm.has_value()},
                                                {"--passes", options.passes.has_value()},
                                                {"--no-perspective-correction", options.noPerspectiveCorrection}};
  for (const auto& [name, used] : given)
    if (used && method == Method::ordinates)
      throw UsageError(std::string(name) + ": is for --method dos, found ordinates");
  if (options.occlusionScale && method == Method::dos)
    throw UsageError("--occlusion-scale: is for --method ordinates, found dos");
}

void applyModel(const SceneOptions& options, Scene& scene) {
  OcclusionOptions& occlusion = scene.occlusion;
  if (options.theta) occlusion.aperture = *options.theta * kRadians;
  apply(options.footprint, occlusion.footprint);
  apply(options.passes, occlusion.passes);
  apply(options.algorithm, occlusion.algorithm);
  apply(options.occlusionBits, occlusion.bits);
  if (options.method) scene.method = *options.method == "dos" ? Method::dos : Method::ordinates;
  checkMethodOptions(options, scene.method);
  apply(options.directions, occlusion.directions);
  apply(options.occlusionScale, occlusion.scale);
  if (options.noPerspectiveCorrection) occlusion.perspectiveCorrection = false;
  if (options.ambient) scene.ambient = toVector(*options.ambient);
  if (options.background) scene.background = toVector(*options.background);
}

// Before what it stands for is given one by one. A volume alone says nothing of its slices: then `normal` does.
void applyQuality(const SceneOptions& options, bool fromScene, Scene& scene) {
  const bool lit = scene.model == Model::cone || scene.model == Model::lights;
  const bool dos = options.method ? *options.method == "dos" : scene.method == Method::dos;
  if (options.quality && (!lit || (options.method && dos)))
    throw UsageError("--quality: is for the models cone and lights by the method ordinates");
  if (options.quality)
    applyQuality(*options.quality == "draft"    ? Quality::draft
                 : *options.quality == "normal" ? Quality::normal
                                                : Quality::high,
                 scene);
  else if (lit && !dos && !fromScene)
    applyQuality(Quality::normal, scene);
  else
    return;
  // Other slabs have segments as long as these, unless told.
  if (options.spacing && options.spacingUnit != "world")
    scene.sampling.segments = std::clamp(static_cast<int>(std::ceil(*options.spacing / 0.625)), 1, 8);
}

void applySampling(const SceneOptions& options, Scene& scene) {
  SamplingOptions& sampling = scene.sampling;
  apply(options.spacing, sampling.spacing);
  if (options.spacingUnit) sampling.spacingInVoxels = *options.spacingUnit == "voxel";
  if (options.quadrature)
    sampling.quadrature = *options.quadrature == "midpoint" ? Quadrature::midpoint : Quadrature::preintegrated;
  apply(options.segments, sampling.segments);
  apply(options.eyeBits, sampling.bits);
  apply(options.saturation, sampling.saturation);
  if (options.tableSize)
    std::cerr << "--table-size has no effect any more: transfer functions are integrated exactly, without a table\n";
  if (options.unbricked) scene.bricks.bricked = false;
  if (options.noCulling) scene.bricks.culling = false;
  apply(options.interior, scene.bricks.interior);
  apply(options.format, scene.bricks.format);
  apply(options.budgetMiB, scene.bricks.budgetMiB);
}

void applyClipping(const SceneOptions& options, Scene& scene) {
  if (!options.clipPlanes.empty()) scene.clipPlanes.clear();
  for (const std::vector<double>& plane : options.clipPlanes)
    scene.clipPlanes.emplace_back(plane[0], plane[1], plane[2], plane[3]);
  if (options.clipBox) {
    const std::vector<double>& box = *options.clipBox;
    scene.clipBox = Box{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  }
}

}  // namespace

std::shared_ptr<SceneOptions> addSceneOptions(CLI::App& command) {
  const auto options = std::make_shared<SceneOptions>();
  SceneOptions& o = *options;
  command.add_option("input", o.input, ".vdb or .nvdb file, or .json scene")->required();
  command.add_option("--grid", o.grid,
                     "grid of the file: name, or name[1] for the second of that name [the only one, or density]");

  const std::string medium = "Medium";
  command.add_option("--tf", o.transfer, "transfer function: a preset or a JSON file")->group(medium);
  command.add_option("--window", o.window, "stretch the transfer function to these values, grid units")
      ->expected(2)
      ->group(medium);
  command.add_option("--sigma-scale", o.sigmaScale, "multiply the extinction [1]")->group(medium);

  const std::string camera = "Camera";
  command.add_option("--azimuth", o.azimuth, "of the eye around the volume, degrees [0]")->group(camera);
  command.add_option("--elevation", o.elevation, "of the eye above the volume, degrees [0]")->group(camera);
  command.add_option("--eye", o.eye, "where the camera stands, world")->expected(3)->group(camera);
  command.add_option("--look-at", o.lookAt, "where it looks, world")->expected(3)->group(camera);
  command.add_option("--up", o.up, "what is up in the picture [0 0 1]")->expected(3)->group(camera);
  command.add_option("--fov", o.fov, "full vertical angle of view, degrees [30]")->group(camera);
  command.add_flag("--orthographic", o.orthographic, "parallel view");
  command.get_option("--orthographic")->group(camera);
  command.add_option("--view-height", o.viewHeight, "of a parallel view, world units, with --eye [1]")->group(camera);
  command.add_option("--near", o.nearDistance, "nothing nearer than this is seen, world units [0]")->group(camera);
  command.add_option("--size", o.size, "of the picture, pixels [512x512]")->group(camera);

  const std::string light = "Light";
  command
      .add_option(
          "--model", o.model,
          "emission (no occlusion), cone (around the slice normal), cone-ray (around the view ray), ambient (whole "
          "sphere) or lights (the scene's light.sources); cone-ray and ambient only in the reference [emission]")
      ->check(CLI::IsMember({"emission", "cone", "cone-ray", "ambient", "lights"}))
      ->group(light);
  command.add_option("--method", o.method, "of the models cone (dos or ordinates) and lights (ordinates) [ordinates]")
      ->check(CLI::IsMember({"dos", "ordinates"}))
      ->group(light);
  command
      .add_option("--quality", o.quality,
                  "draft, normal or high: ordinates with spacing, segments and directions that go together; options "
                  "that name one of them win [of a .vdb: normal]")
      ->check(CLI::IsMember({"draft", "normal", "high"}))
      ->group(light);
  command
      .add_option("--directions", o.directions,
                  "K: about so many over the cone, the sphere or the lights; ordinates: 1 to 1024 [16], reference by "
                  "quadrature: 1 to 1000000 [256]")
      ->check(CLI::Range(1, 1000000))
      ->group(light);
  command
      .add_option("--occlusion-scale", o.occlusionScale,
                  "of ordinates: window texels per voxel edge [0: a texel is as large as the larger of slab and voxel, "
                  "in huge volumes 1/2048 of the diagonal]")
      ->group(light);
  command.add_option("--theta", o.theta, "half-angle of the cone, degrees, in [0, 90) [60]")->group(light);
  command.add_option("--footprint", o.footprint, "n: n x n samples over the cone's footprint, 1 to 16 [3]")
      ->group(light);
  command.add_option("--algorithm", o.algorithm, "2: exact distance per sample, 3: slice distance [3]")->group(light);
  command.add_option("--passes", o.passes, "2: two passes per slice, 1: multiple render targets [1]")->group(light);
  command
      .add_option("--occlusion-bits", o.occlusionBits,
                  "of the occlusion buffer or the windows: 32 (float) or 16 (fixed point, see --eye-bits) [32]")
      ->group(light);
  command.add_flag("--no-perspective-correction", o.noPerspectiveCorrection, "footprint as in a parallel view")
      ->group(light);
  command.add_option("--ambient", o.ambient, "radiance from every direction, linear RGB [1 1 1]")
      ->expected(3)
      ->group(light);
  command
      .add_option("--background", o.background,
                  "radiance behind the volume, linear RGB; makes the picture opaque [none]")
      ->expected(3)
      ->group(light);

  const std::string sampling = "Sampling";
  command.add_option("--spacing", o.spacing, "distance of slices [0.5; cone and lights of a .vdb: as --quality says]")
      ->group(sampling);
  command.add_option("--spacing-unit", o.spacingUnit, "voxel (its shortest edge) or world [voxel]")
      ->check(CLI::IsMember({"voxel", "world"}))
      ->group(sampling);
  command.add_option("--quadrature", o.quadrature, "of a slab: preintegrated or midpoint [preintegrated]")
      ->check(CLI::IsMember({"preintegrated", "midpoint"}))
      ->group(sampling);
  command
      .add_option(
          "--segments", o.segments,
          "of a slab, integrated one by one along the ray, 1 to 8 [1; with --quality: no longer than 0.6 voxels]")
      ->group(sampling);
  command
      .add_option("--table-size", o.tableSize,
                  "no effect: there is no table any more; kept so that earlier commands work")
      ->group(sampling);
  command
      .add_option(
          "--eye-bits", o.eyeBits,
          "of the eye buffer: 32 (float) or 16 (fixed point, off by up to 2.3e-5 per slice; slabs of less opacity "
          "than 8e-6 are lost) [32]")
      ->group(sampling);
  command.add_option("--saturation", o.saturation, "transmittance below which a pixel is done; 0: never [0.001]")
      ->group(sampling);

  const std::string clip = "Clipping";
  command.add_option("--clip-plane", o.clipPlanes, "a b c d: keep a x + b y + c z + d >= 0, world; may be repeated")
      ->type_size(4)
      ->group(clip);
  command.add_option("--clip-box", o.clipBox, "keep x0 y0 z0 x1 y1 z1, world")->expected(6)->group(clip);

  const std::string bricks = "Bricks";
  command
      .add_option("--brick-edge", o.interior,
                  "owned voxels along an edge: 8 to 256, a multiple of 8 [0: from the sizes of slabs and pixels]")
      ->group(bricks);
  command.add_flag("--unbricked", o.unbricked, "the whole volume as one texture")->group(bricks);
  command.add_flag("--no-culling", o.noCulling, "draw bricks that the transfer function makes invisible, too")
      ->group(bricks);
  command
      .add_option("--texel-format", o.format, "auto, unorm8, unorm16, half or float32 [auto: the smallest exact one]")
      ->group(bricks);
  command.add_option("--memory-budget", o.budgetMiB, "of the bricks' textures, MiB [2048]")->group(bricks);
  return options;
}

void addBackendOption(CLI::App& command, std::string& backend) {
  command.add_option("--backend", backend, "OpenGL: auto (OSMesa, else EGL), osmesa or egl")
      ->check(CLI::IsMember({"auto", "osmesa", "egl"}))
      ->capture_default_str();
}

Scene makeScene(const SceneOptions& options, const DefaultTransfer& defaultTransfer) {
  Scene scene;
  if (options.input.extension() == ".json")
    scene = readScene(options.input);
  else
    scene.volume.file = options.input;
  apply(options.grid, scene.volume.grid);
  applyTransfer(options, defaultTransfer, scene);
  applyCamera(options, scene);
  if (options.model) scene.model = parseModel(*options.model);
  applyQuality(options, options.input.extension() == ".json", scene);
  applyModel(options, scene);
  applySampling(options, scene);
  applyClipping(options, scene);
  validateScene(scene);
  return scene;
}

std::unique_ptr<Bricks> cutBricks(const ScalarGrid& grid, const Scene& resolved) {
  BrickOptions options;
  options.interior = resolved.bricks.interior;
  options.apron = requiredApron(resolved, grid.indexToWorld());
  options.gradients = resolved.transfer->is2d();
  return resolved.bricks.bricked ? brickGrid(grid, options) : unbrickedGrid(grid, options);
}

LoadedVolume loadVolume(const Scene& scene) {
  LoadedVolume loaded;
  const Stopwatch load;
  loaded.grid = readScalarGrid(scene.volume.file, scene.volume.grid);
  loaded.loadMs = load.elapsedMs();
  if (loaded.grid.activeBox().empty())
    throw InvalidArgument(scene.volume.file.string() + ": grid \"" + loaded.grid.name + "\" has no active voxel");
  const glm::dmat4 indexToWorld = loaded.grid.indexToWorld();
  loaded.scene = resolveScene(scene, loaded.grid.worldBounds(), indexToWorld);
  loaded.scene.bricks.interior = brickInterior(loaded.scene, indexToWorld, loaded.grid.worldBounds());
  return loaded;
}

void warnOfNonFinite(const Scene& scene, std::uint64_t voxels) {
  if (voxels > 0)
    std::cerr << scene.volume.file.string() << ": " << voxels << " voxels are not finite and count as background\n";
}

LoadedScene loadScene(const Scene& scene, bool coarserToo) {
  LoadedScene loaded{loadVolume(scene)};
  const Stopwatch brick;
  const Scene coarser = coarserScene(loaded.scene);
  try {
    if (coarserToo) requiredApron(coarser, loaded.grid.indexToWorld());
  } catch (const InvalidArgument&) {
    coarserToo = false;
  }
  loaded.bricks = cutBricks(loaded.grid, coarserToo ? coarser : loaded.scene);
  loaded.brickMs = brick.elapsedMs();
  warnOfNonFinite(scene, loaded.bricks->nonFiniteVoxels);
  return loaded;
}

}  // namespace umbrick::tools
