// How .vdb files are packed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace umbrick {

/// How the values in a .vdb are packed.
enum class VdbCodec { blosc, zip, none };

/// The same as OpenVDB's flags: inactive values are left out; Blosc becomes zip where OpenVDB was built without it.
std::uint32_t compressionOf(VdbCodec codec);

}  // namespace umbrick
