// SPDX-License-Identifier: Apache-2.0
#include "ingest/provenance.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <sstream>

#include "umbrick/core/error.h"

namespace umbrick {

void addProvenance(VolumeInfo& info, const std::filesystem::path& path, std::string_view format) {
  info.metadata["source_format"] = format;
  info.metadata["source_file"] = (path.has_filename() ? path : path.parent_path()).filename().string();
}

void checkPlace(const VolumeInfo& info, const std::string& field) {
  const glm::dmat4& m = info.indexToWorld;
  double volume = 1;
  bool finite = true;
  for (int axis = 0; axis < 4; ++axis)
    for (int row = 0; row < 3; ++row) finite = finite && std::isfinite(m[axis][row]);
  for (int axis = 0; axis < 3; ++axis) volume *= glm::length(glm::dvec3(m[axis]));
  // 1e-9: far below the sine of any angle between scanned axes, far above what rounding makes of two that coincide.
  if (finite && std::abs(glm::determinant(glm::dmat3(m))) > 1e-9 * volume) return;
  std::ostringstream text;
  text << info.name << ": " << field << ": expected finite numbers and three independent directions, found columns";
  for (int axis = 0; axis < 4; ++axis) text << " (" << m[axis].x << ' ' << m[axis].y << ' ' << m[axis].z << ')';
  throw IoError(text.str());
}

}  // namespace umbrick
