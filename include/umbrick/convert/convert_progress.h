// How far a conversion is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>

namespace umbrick {

/// What the voxels of an input are read for.
enum class ConvertStage { converting, verifying, planning };

struct ConvertProgress {
  ConvertStage stage = ConvertStage::converting;
  std::filesystem::path input;
  double bytes = 0;  // that this stage reads of the input, unpacked; 0: not known
  double share = 0;  // of the stage that is done, in [0, 1]; begins at 0 for each input and stage
};

/// Is called in the thread of the caller, now and then. What it throws ends the conversion, which then leaves no file.
using ConvertProgressCallback = std::function<void(const ConvertProgress&)>;

}  // namespace umbrick
