// A scene from Python: a dictionary or a file, and keywords that are named as the options of umbrick render.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "umbrick/render/asked_scene.h"

namespace umbrick::python {

/// A scene with the changes that keywords make, which messages name: "sigma_scale".
struct ScenePlea : AskedScene {
  Scene given;
  std::string nameOf(std::string_view option) const override;
};

/// Returns all keywords of a scene: those of the table of fields and those of AskedScene.
std::vector<std::string> sceneKeywords();

/// Reads a scene and keywords.
/// @param scene     None, the text of a dictionary, or a pathlib.Path of a .json file
/// @param keywords  by name; their values as in the JSON of a scene
/// @throw InvalidArgument  a value of another kind, named by its keyword or its path in the dictionary
/// @throw IoError          the file cannot be read
ScenePlea readScenePlea(const pybind11::object& scene, const pybind11::dict& keywords);

/// Applies keywords to a scene that is whole, as it is drawn now. @throw InvalidArgument
ScenePlea changePlea(const Scene& scene, const pybind11::dict& keywords);

}  // namespace umbrick::python
