// SPDX-License-Identifier: Apache-2.0
#include "convert/pass.h"

namespace umbrick {

std::function<void(double)> beginPass(const ConvertProgressCallback& progress, ConvertStage stage,
                                      const std::filesystem::path& input, double bytes) {
  if (!progress) return {};
  progress({stage, input, bytes, 0});
  return [=](double share) { progress({stage, input, bytes, share}); };
}

double unpackedBytes(const VolumeInfo& info) {
  return double(info.dims.x) * double(info.dims.y) * double(info.dims.z) * voxelBytes(info.type);
}

}  // namespace umbrick
