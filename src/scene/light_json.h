// Reads and writes light sources as JSON, see parseScene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/json_reader.h"
#include "umbrick/scene/light_source.h"

namespace umbrick {
class SceneFolder;

/// Reads three numbers. @throw IoError  anything else
glm::dvec3 readVector(const JsonValue& value);

/// Reads a light source. @param folder  that file names are relative to
LightSource readLightSource(const JsonValue& value, const SceneFolder& folder);
std::string printLightSource(const LightSource& source);

}  // namespace umbrick
