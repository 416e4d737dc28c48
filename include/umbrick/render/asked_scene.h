// What a user says of a scene in single words, and what is chosen where nothing is said. The command line and other
// languages fill the same struct, so that the same words make the same picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "umbrick/render/suggest_transfer.h"
#include "umbrick/render/volume.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// What is asked for does not go together, or does not fit the volume. The message has the user's own words.
struct AskedSceneError : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

/// Options of a scene, by the names that the table of fields gives them (scene_fields.h), and those that are more or
/// less than a field.
struct AskedScene {
  /// The scene that the options change is whole, as that of a file: what it leaves out has its default. Else what
  /// nobody says is chosen so that a picture shows something.
  bool whole = false;
  std::optional<std::string> transfer;         // "tf": a preset, a file, or "auto"
  std::optional<TransferFunction> function;    // "tf" that is given itself
  std::optional<std::string> quality, view;    // of kQualities; see namedView()
  std::optional<std::string> up;               // an axis, or, as it was written, a direction
  std::optional<std::vector<double>> upward;   // that direction, where `up` is one
  std::optional<std::vector<double>> window;   // two values, grid units
  std::optional<std::vector<double>> clipBox;  // x0 y0 z0 x1 y1 z1, world
  std::vector<std::vector<double>> clipPlanes;
  std::optional<double> sigmaScale;
  std::vector<double> isoValues, isoOpacities;  // of isosurfaces, one after another
  std::vector<std::vector<double>> isoColours;
  std::optional<std::string> mesh;              // its file
  std::optional<std::string> emissionTransfer;  // "emission-tf": a preset or a file, which makes the kind a table
  bool orthographic = false;
  /// Sets the field of each option of the table of scene fields that was given, by the name of the option.
  std::map<std::string, std::function<void(Scene&)>, std::less<>> fields;

  virtual ~AskedScene() = default;
  /// Returns how the user writes an option: "--theta" on a command line.
  virtual std::string nameOf(std::string_view option) const { return std::string(option); }
  bool has(std::string_view option) const { return fields.contains(option); }
};

/// What a picture shows where neither options nor a scene say it.
struct SceneDefaults {
  Model model = Model::emission;
  /// A grid that emits light is looked for, where no transfer function is given.
  bool emission = false;
};

/// Keys of a scene that an option takes the place of: what is asked for holds at all frames.
struct ReplacedKeys {
  std::string option;  // in the user's words
  std::string field;   // path of the field
};

/// Makes a scene before its volume is known: what is wrong is said before anything is loaded. Without a transfer
/// function, none is set.
/// @param scene  that the options change; of one that is not whole only the volume counts
/// @param replaced  gets the keys that are dropped; may be null
/// @throw AskedSceneError  @throw IoError, InvalidArgument  as readers and validateScene, in the user's words
Scene askedScene(const AskedScene& asked, Scene scene, const SceneDefaults& defaults = {},
                 std::vector<ReplacedKeys>* replaced = nullptr);

/// Applies "window" and "sigma-scale", where the scene has a transfer function.
void applyWindow(const AskedScene& asked, Scene& scene);

/// How a picture is made, as far as a scene follows from it.
struct AskedPicture {
  bool progressive = false;  // the mean of samples
  bool target = false;       // of them as many as an error needs
  bool onCpu = false;        // nothing but the CPU may draw
};
/// Fits a scene to the way it is drawn: methods that nobody has named are those that suit it.
/// @throw AskedSceneError  pictures of the scene cannot be averaged
void fitToPicture(const AskedScene& asked, const AskedPicture& picture, Scene& scene);

/// What is known of a volume that is one of many: where nothing is given, the volume itself is asked.
struct SceneHints {
  std::optional<SuggestedTransfer> transfer = {};
  std::optional<Box> seen = {};  // what is visible, world units
};

/// A scene with a transfer function and with the axes of its orbit, and what was chosen.
struct CompletedScene {
  Scene scene;
  std::vector<std::pair<std::string, std::string>> chosen;  // options that repeat the choices, with their values
  std::vector<std::string> reasons;                         // for people
  bool view = false;                                        // the direction of the view is among them
  /// Which way is up and how fine a picture is are told only beside a choice that users may want to change.
  bool matters() const { return view || !reasons.empty(); }
};

/// Completes a scene of askedScene() for a volume that is loaded. @throw AskedSceneError, InvalidArgument
CompletedScene completedScene(const AskedScene& asked, Scene scene, const Volume& volume, const SceneHints& hints = {});

}  // namespace umbrick
