// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/asked_scene.h"

#include <algorithm>
#include <numbers>

#include "umbrick/core/error.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/mesh/mesh_file.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

// A picture of a volume of which nothing is said shows it from the front, a little from its side and from above, where
// its shape is seen best.
constexpr Orbit kFirstLook{.azimuth = 30 * kRadiansPerDegree, .elevation = 15 * kRadiansPerDegree};

// The words of a user, for messages.
struct Words {
  const AskedScene& asked;
  std::string operator()(std::string_view option) const { return asked.nameOf(option); }
  // "--view, --azimuth and --zoom"
  std::string all(const std::vector<std::string_view>& options) const {
    std::string text;
    for (std::size_t i = 0; i < options.size(); ++i)
      text += (i == 0 ? "" : i + 1 < options.size() ? ", " : " and ") + asked.nameOf(options[i]);
    return text;
  }
};

glm::dvec3 vectorOf(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// What is wrong with a field that an option has set is said by the option's name.
void validateAsked(const AskedScene& asked, const Scene& scene) {
  try {
    validateScene(scene);
  } catch (const InvalidArgument& error) {
    const std::string message = error.what();
    const SceneField* field = findSceneField(message.substr(0, message.find(':')));
    if (!field || !asked.has(field->option)) throw;
    throw InvalidArgument(asked.nameOf(field->option) + message.substr(message.find(':')));
  }
}

Axis upAxis(const AskedScene& asked) {
  try {
    return parseName(kAxes, *asked.up, asked.nameOf("up"));
  } catch (const InvalidArgument& error) {
    throw AskedSceneError(error.what());
  }
}

// Sets what is up: an axis or three numbers.
void applyUp(const AskedScene& asked, Scene& scene) {
  const std::string name = asked.nameOf("up");
  if (scene.orbit) {
    if (asked.upward)
      throw AskedSceneError(name + ": three numbers need " + asked.nameOf("eye") +
                            "; around the volume it is x, y, z, -x, -y, -z or auto");
    scene.orbit->up = upAxis(asked);
    return;
  }
  if (asked.upward && asked.upward->size() == 3)
    scene.camera.up = vectorOf(*asked.upward);
  else if (asked.upward || *asked.up == "auto")
    throw AskedSceneError(name + ": beside an eye, expected three numbers or one of x, y, z, -x, -y, -z, found '" +
                          *asked.up + "'");
  else
    scene.camera.up = axisDirection(upAxis(asked));
}

// Places the camera. An eye replaces the angles around the volume, and angles replace an eye.
void placeCamera(const AskedScene& asked, Scene& scene) {
  const Words words{asked};
  Camera& camera = scene.camera;
  if (asked.orthographic) camera.projection = Projection::orthographic;
  const bool turned = asked.has("azimuth") || asked.has("elevation");
  if (asked.view && turned)
    throw AskedSceneError(words("view") + " and " + words("azimuth") + ", " + words("elevation") +
                          " exclude each other");
  const bool angles = asked.view || turned || asked.has("front") || asked.has("zoom") || asked.has("pan");
  const bool eye = asked.has("eye"), lookAt = asked.has("look-at");
  if (eye && angles)
    throw AskedSceneError(words("eye") + " excludes " +
                          words.all({"view", "azimuth", "elevation", "front", "zoom", "pan"}));
  if (eye || (lookAt && !scene.orbit)) {
    if (scene.orbit && !lookAt) throw AskedSceneError(words("eye") + " needs " + words("look-at"));
    if (scene.orbit) camera.up = {0, 0, 1};
    scene.orbit.reset();
  }
  if (angles && !scene.orbit) scene.orbit = Orbit{};
  if (scene.orbit && (lookAt || asked.has("view-height")))
    throw AskedSceneError(words.all({"look-at", "view-height"}) + " need " + words("eye"));
  if (scene.orbit && !asked.whole && !asked.view && !turned) scene.orbit = kFirstLook;
  if (asked.up) applyUp(asked, scene);
}

// Without a transfer function in the scene or in words it is made when the volume is known, and so are window and scale
// of it.
void applyTransfer(const AskedScene& asked, Scene& scene) {
  if (asked.function)
    scene.transfer = asked.function;
  else if (asked.transfer && *asked.transfer == "auto")
    scene.transfer.reset();
  else if (asked.transfer)
    scene.transfer = loadTransferFunction(*asked.transfer);
  applyWindow(asked, scene);
}

// Applies model and method, and then the quality, before the fields that it sets are given one by one. A scene that is
// not whole has no slices of its own, so that `normal` applies.
void applyAskedQuality(const AskedScene& asked, Scene& scene) {
  for (const char* option : {"model", "method"})
    if (asked.has(option)) asked.fields.find(option)->second(scene);
  const bool lit = traitsOf(scene.model).directions, byDirections = traitsOf(scene.method).directions;
  const std::string name = asked.nameOf("quality");
  if (asked.quality && (!lit || (asked.has("method") && !byDirections)))
    throw AskedSceneError(name +
                          ": is for the models cone, ambient and lights by the methods ordinates and light-volume; "
                          "give " +
                          asked.nameOf("model") + " cone");
  if (asked.quality)
    applyQuality(parseName(kQualities, *asked.quality, name), scene);
  else if (lit && byDirections && !asked.whole)
    applyQuality(Quality::normal, scene);
  else
    return;
  // Slabs of another spacing have segments as long as these, unless the user gives their number.
  if (!asked.has("spacing")) return;
  Scene spaced = scene;
  for (const char* option : {"spacing", "spacing-unit"})
    if (asked.has(option)) asked.fields.find(option)->second(spaced);
  if (spaced.spacingUnit == SpacingUnit::voxel) scene.sampling.segments = segmentsOf(spaced.sampling.spacing);
}

std::string methodsOf(const SceneField& field) {
  std::string names;
  for (const Method method : field.onlyOf) names += (names.empty() ? "" : " or ") + methodName(method);
  return names;
}

// Refuses an option that only the other methods look at, since it shows that the user expects that method.
void checkMethodOptions(const AskedScene& asked, Method method) {
  for (const SceneField& field : sceneFields())
    if (!field.onlyOf.empty() && std::ranges::find(field.onlyOf, method) == field.onlyOf.end() &&
        asked.has(field.option))
      throw AskedSceneError(asked.nameOf(field.option) + ": is for " + asked.nameOf("method") + ' ' + methodsOf(field) +
                            ", found " + methodName(method));
}

void applyClipping(const AskedScene& asked, Scene& scene) {
  if (!asked.clipPlanes.empty()) scene.clipPlanes.clear();
  for (const std::vector<double>& plane : asked.clipPlanes)
    scene.clipPlanes.emplace_back(plane[0], plane[1], plane[2], plane[3]);
  if (asked.clipBox) {
    const std::vector<double>& box = *asked.clipBox;
    scene.clipBox = Box{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  }
}

// Makes the surfaces of a scene.
void applySurfaces(const AskedScene& asked, Scene& scene) {
  const bool given = !asked.isoValues.empty() || !asked.isoColours.empty() || !asked.isoOpacities.empty();
  if (!given) return;
  if (!traitsOf(scene.mode).surfaces)
    throw AskedSceneError(Words{asked}.all({"iso", "iso-colours", "iso-opacity"}) + " are for " + asked.nameOf("mode") +
                          " isosurface and hybrid, found " + modeName(scene.mode));
  if (!asked.isoValues.empty()) {
    scene.surfaces.assign(asked.isoValues.size(), SceneSurface{});
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) scene.surfaces[i].value = asked.isoValues[i];
  }
  // A level set has a surface of its own.
  if (scene.surfaces.empty()) scene.surfaces.resize(1);
  const std::size_t count = scene.surfaces.size();
  const auto tooMany = [&](const char* option, std::size_t found) {
    throw AskedSceneError(asked.nameOf(option) + ": expected " + std::to_string(count) +
                          (count == 1 ? ", as there is one surface" : ", as many as there are surfaces") + ", found " +
                          std::to_string(found));
  };
  if (asked.isoColours.size() > count) tooMany("iso-colours", asked.isoColours.size());
  if (asked.isoOpacities.size() > 1 && asked.isoOpacities.size() != count)
    tooMany("iso-opacity", asked.isoOpacities.size());
  for (std::size_t i = 0; i < asked.isoColours.size(); ++i) scene.surfaces[i].colour = vectorOf(asked.isoColours[i]);
  if (asked.isoOpacities.empty()) return;
  for (std::size_t i = 0; i < count; ++i)
    scene.surfaces[i].opacity = asked.isoOpacities[asked.isoOpacities.size() == 1 ? 0 : i];
}

void applyMesh(const AskedScene& asked, Scene& scene) {
  if (asked.mesh) {
    scene.mesh.file = *asked.mesh;
    scene.mesh.shape = readMesh(*asked.mesh);
  }
  if (asked.has("mesh-colour") && !scene.mesh.shape)
    throw AskedSceneError(asked.nameOf("mesh-colour") + ": needs " + asked.nameOf("mesh"));
}

// A grid that emits light is looked for where the scene can show it.
void applyEmission(const AskedScene& asked, const SceneDefaults& defaults, Scene& scene) {
  if (asked.emissionTransfer) {
    scene.emission.table = loadTransferFunction(*asked.emissionTransfer);
    if (!asked.has("emission-kind")) scene.emission.kind = EmissionKind::table;
  }
  if (asked.whole || !defaults.emission || scene.transfer || !scene.volume.emissionGrid.empty()) return;
  Scene emitting = scene;
  emitting.volume.emissionGrid = "any";
  const bool shown = emits(emitting) && scene.sampling.classification == Classification::post &&
                     (scene.technique == Technique::automatic || supportsMode(emitting, scene.technique));
  if (shown) scene.volume.emissionGrid = kAutomaticGrid;
}

// What is asked for holds at all frames.
std::vector<ReplacedKeys> dropReplacedKeys(const AskedScene& asked, Scene& scene) {
  std::vector<ReplacedKeys> replaced;
  const auto drop = [&](const std::string& option, std::string_view field) {
    if (dropKeys(scene, field)) replaced.push_back({option, std::string(field)});
  };
  for (const auto& [option, set] : asked.fields)
    if (const SceneField* field = findSceneField(option)) drop(asked.nameOf(option), field->path);
  if (asked.view)
    for (const char* field : {"camera.azimuth", "camera.elevation"}) drop(asked.nameOf("view"), field);
  if (asked.up) drop(asked.nameOf("up"), "camera.up");
  if (asked.transfer || asked.function) drop(asked.nameOf("tf"), "transfer");
  if (!asked.clipPlanes.empty()) drop(asked.nameOf("clip-plane"), "clip.planes");
  if (asked.clipBox) drop(asked.nameOf("clip-box"), "clip.box");
  if (!asked.isoValues.empty() || !asked.isoOpacities.empty()) drop(asked.nameOf("iso"), "surfaces");
  // A camera that is placed in another way than the keys place it.
  const Words words{asked};
  if (scene.orbit)
    for (const char* field : {"camera.eye", "camera.lookAt", "camera.up", "camera.viewHeight"})
      drop(words.all({"azimuth", "elevation", "view"}), field);
  else
    for (const char* field : {"camera.azimuth", "camera.elevation", "camera.zoom", "camera.pan"})
      drop(words("eye"), field);
  return replaced;
}

}  // namespace

Scene askedScene(const AskedScene& asked, Scene scene, const SceneDefaults& defaults,
                 std::vector<ReplacedKeys>* replaced) {
  if (!asked.whole) scene.model = defaults.model;
  // Other modes, and light that is reflected, go with no light in the medium.
  for (const char* option : {"mode", "shading"})
    if (asked.has(option)) asked.fields.find(option)->second(scene);
  if (!asked.whole && (scene.mode != Mode::integrate || isShaded(scene))) scene.model = Model::emission;
  applyTransfer(asked, scene);
  placeCamera(asked, scene);
  applyAskedQuality(asked, scene);
  for (const auto& [option, set] : asked.fields) set(scene);
  std::vector<ReplacedKeys> dropped = dropReplacedKeys(asked, scene);
  if (replaced) *replaced = std::move(dropped);
  checkMethodOptions(asked, scene.method);
  applyClipping(asked, scene);
  applySurfaces(asked, scene);
  applyMesh(asked, scene);
  applyEmission(asked, defaults, scene);
  validateAsked(asked, scene);
  return scene;
}

void applyWindow(const AskedScene& asked, Scene& scene) {
  if (!scene.transfer) return;
  if (asked.window) scene.transfer = scene.transfer->windowed((*asked.window)[0], (*asked.window)[1]);
  if (asked.sigmaScale) scene.transfer = scene.transfer->scaled(*asked.sigmaScale);
  for (SceneTrack& track : scene.tracks)
    for (SceneTrack::Key& key : track.keys) {
      if (key.transfer && asked.window) key.transfer = key.transfer->windowed((*asked.window)[0], (*asked.window)[1]);
      if (key.transfer && asked.sigmaScale) key.transfer = key.transfer->scaled(*asked.sigmaScale);
    }
}

void fitToPicture(const AskedScene& asked, const AskedPicture& picture, Scene& scene) {
  if (picture.progressive && !canAverage(scene))
    throw AskedSceneError(Words{asked}.all({"progressive", "max-seconds", "target-error"}) +
                          " need the model emission, or cone, ambient or lights and the method ordinates or "
                          "light-volume");
  // Ordinates can be refined further than light at voxels, so that a target takes them where there is OpenGL, unless
  // the user names a method.
  if (picture.target && !picture.onCpu && !asked.has("method")) scene.method = Method::ordinates;
  // A draft is one of slices, but where these cannot be.
  const bool bySlices =
      !picture.onCpu && (scene.technique == Technique::automatic || scene.technique == Technique::slices);
  if (!bySlices && asked.quality && !asked.has("method")) scene.method = Method::lightVolume;
  // Surfaces take light from a light volume alone.
  if (traitsOf(scene.mode).surfaces && !asked.has("method")) scene.method = Method::lightVolume;
}

}  // namespace umbrick
