// Checks the ranges of a scene's fields, in one place for scenes from files and from code.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "umbrick/scene/scene.h"

namespace umbrick {

struct Complaint {
  std::string field;    // path as in the JSON: "occlusion.theta", "clip.planes[2]"
  std::string message;  // "is 90 degrees, must be in [0, 90)"
};

/// Returns the first field that is out of its range, if there is one.
std::optional<Complaint> findComplaint(const Scene& scene);

}  // namespace umbrick
