// A small headerless volume with a block of noise in a border of one value.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/convert/convert_options.h"
#include "umbrick/core/random.h"

namespace umbrick {

struct NoisyVolume {
  static constexpr int kEdge = 24;
  float border = 0;           // grid units
  std::vector<float> voxels;  // x fastest

  explicit NoisyVolume(std::uint64_t seed, float borderValue = 0) : border(borderValue), voxels(kEdge * kEdge * kEdge) {
    Random random(seed);
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x)
          at(x, y, z) = inside(x) && inside(y) && inside(z) ? static_cast<float>(100 * random.uniform()) : border;
  }
  static bool inside(int i) { return i >= 4 && i < 20; }
  float& at(int x, int y, int z) { return voxels[static_cast<std::size_t>((z * kEdge + y) * kEdge + x)]; }

  std::filesystem::path write(const TemporaryFolder& folder, const char* name) const {
    writeBytes(folder.path() / name, bytesOf(voxels));
    return folder.path() / name;
  }
};

/// Options that read such a volume.
inline ConvertOptions noisyOptions() {
  RawOptions raw;
  raw.dims = glm::i64vec3(NoisyVolume::kEdge);
  raw.type = VoxelType::f32;
  ConvertOptions options;
  options.source.open.raw = raw;
  return options;
}

}  // namespace umbrick
