// Writes the value of a field as text, for scenes, messages and help.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/scene/scene_fields.h"

namespace umbrick {

/// Returns the value as JSON; empty where the scene has no such field, or an optional one is not set.
/// @throw InvalidArgument  the value is not finite
std::string jsonText(const FieldPlace& place);

/// Returns the value as messages show it: any number, angles with their unit.
std::string messageText(const FieldPlace& place);

/// Tells whether the value is in its range.
bool inRange(const FieldPlace& place, const FieldRange& range);

}  // namespace umbrick
