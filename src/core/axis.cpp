// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/axis.h"

#include "umbrick/core/error.h"

namespace umbrick {

glm::dvec3 axisDirection(Axis axis) {
  switch (axis) {
    case Axis::x:
      return {1, 0, 0};
    case Axis::y:
      return {0, 1, 0};
    case Axis::z:
      return {0, 0, 1};
    case Axis::minusX:
      return {-1, 0, 0};
    case Axis::minusY:
      return {0, -1, 0};
    case Axis::minusZ:
      return {0, 0, -1};
    case Axis::automatic:
      break;
  }
  throw InvalidArgument("axis: expected one of x, y, z, -x, -y, -z, found auto");
}

Axis usualFront(Axis up) {
  const glm::dvec3 direction = axisDirection(up);
  return direction.z != 0 ? Axis::minusY : Axis::z;
}

}  // namespace umbrick
