// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/volume_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// Calls use(voxels) for one slab after the other. @return the largest error of the conversion to float
template <class Use>
double overSlabs(VoxelSource& source, const Use& use) {
  constexpr std::int64_t kPartVoxels = std::int64_t(1) << 22;
  const glm::i64vec3 dims = source.info().dims;
  const std::int64_t slice = dims.x * dims.y;
  const std::int64_t atOnce = std::clamp<std::int64_t>(kPartVoxels / slice, 1, dims.z);
  std::vector<float> slab;
  double error = 0;
  for (std::int64_t z = 0; z < dims.z; z += atOnce) {
    const std::int64_t slices = std::min(atOnce, dims.z - z);
    slab.resize(static_cast<std::size_t>(slices * slice));
    error = std::max(error, source.readSlab(slices, slab));
    use(slab);
  }
  return error;
}

}  // namespace

VolumeValues volumeValues(const std::function<std::unique_ptr<VoxelSource>()>& open, int bins) {
  if (bins < 1) throw InvalidArgument("bins: expected 1 or more, found " + std::to_string(bins));
  VolumeValues out;
  out.min = std::numeric_limits<float>::infinity();
  out.max = -out.min;
  out.conversionError = overSlabs(*open(), [&](const std::vector<float>& voxels) {
    for (const float value : voxels) {
      if (!std::isfinite(value)) {
        ++out.nonFinite;
        continue;
      }
      out.min = std::min(out.min, value);
      out.max = std::max(out.max, value);
    }
  });
  if (out.min > out.max) {
    out.min = out.max = std::numeric_limits<float>::quiet_NaN();
    return out;
  }
  out.histogram.resize(static_cast<std::size_t>(bins));
  const double low = out.min, extent = static_cast<double>(out.max) - low;
  overSlabs(*open(), [&](const std::vector<float>& voxels) {
    for (const float value : voxels) {
      if (!std::isfinite(value)) continue;
      const double share = extent > 0 ? (static_cast<double>(value) - low) / extent : 0.0;
      ++out.histogram[std::min(static_cast<std::size_t>(share * bins), static_cast<std::size_t>(bins - 1))];
    }
  });
  return out;
}

}  // namespace umbrick
