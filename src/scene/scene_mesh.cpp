// SPDX-License-Identifier: Apache-2.0
#include "umbrick/mesh/mesh.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

bool SceneMesh::operator==(const SceneMesh& other) const {
  if (file != other.file || colour != other.colour) return false;
  return shape == other.shape || (shape && other.shape && *shape == *other.shape);
}

}  // namespace umbrick
