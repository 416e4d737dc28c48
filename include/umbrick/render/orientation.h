// Views of a volume by the way it stands in the world.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/grid/orientation.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// Returns the axes of an orbit with what is automatic filled in.
Orbit settledOrbit(const Orbit& orbit, const Orientation& orientation);

/// Turns an orbit to a view by its name: front, back, left, right, top or bottom of anything, and anterior, posterior,
/// left, right, superior or inferior of a patient, whose left and right are the patient's own. Without a patient, left
/// is what lies on the left in the view of the front.
/// @throw InvalidArgument  no such view, or one of a patient of a volume that does not state its anatomy
Orbit namedView(std::string_view name, Orbit orbit, const Orientation& orientation);

/// Returns the names of views that namedView() knows of some volume or other, each once.
std::vector<std::string> viewNames();

}  // namespace umbrick
