// Parts of a scene that are read from JSON in more than one place.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/json_reader.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick {

/// Sets a field to a value of its kind. Ranges are checked once the scene is complete.
void readField(const JsonValue& value, const FieldPlace& place);

void readSurfaces(const JsonValue& value, Scene& scene);
void readClipPlanes(const JsonValue& value, Scene& scene);
void readClipBox(const JsonValue& value, Scene& scene);

std::string printedSurfaces(const Scene& scene);
std::string printedClipPlanes(const Scene& scene);
/// @pre the scene has a clip box
std::string printedClipBox(const Scene& scene);

}  // namespace umbrick
