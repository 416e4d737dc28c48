// How .vdb files are packed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace umbrick {

/// How the values in a .vdb file are packed.
enum class VdbCodec { blosc, zip, none };

/// Returns OpenVDB's flags for a codec. Inactive values are left out, and Blosc becomes zip where OpenVDB was
/// built without it.
std::uint32_t compressionOf(VdbCodec codec);

}  // namespace umbrick
