#include "umbrick/shade/prepare.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

int requiredApron(const Scene& resolved, const glm::dmat4& indexToWorld) {
  const IndexView view = indexView(resolved.camera, indexToWorld);
  double reach = 0;
  if (resolved.sampling.quadrature == Quadrature::preintegrated) {
    const glm::dvec3 axes = slabReach(view, resolved.sampling.spacing);
    reach = std::max({axes.x, axes.y, axes.z});
  }
  // Half a voxel belongs to every apron: a brick's space ends half-way between its last voxel and the first ghost. What
  // rounding may add is left to the texture filter.
  const double wanted = std::ceil(0.5 + reach - 1e-9);
  if (!(wanted <= resolved.bricks.interior))
    throw InvalidArgument("sampling: slices " + std::to_string(resolved.sampling.spacing) + " apart reach " +
                          std::to_string(static_cast<long long>(std::min(wanted, 9e15))) +
                          " voxels beyond a brick, more than its edge of " + std::to_string(resolved.bricks.interior));
  return std::max(1, static_cast<int>(wanted));
}

}  // namespace umbrick
