// SPDX-License-Identifier: Apache-2.0
#include "convert_progress.h"

#include <utility>

#include "umbrick/core/error.h"

namespace umbrick::tools {
namespace {

std::string label(const ConvertProgress& progress) {
  const std::string name = progress.input.filename().string();
  switch (progress.stage) {
    case ConvertStage::converting:
      return "converting " + name;
    case ConvertStage::verifying:
      return "verifying " + name;
    case ConvertStage::planning:
      break;
  }
  return "planning " + name;
}

}  // namespace

ConvertProgressCallback showProgress(ProgressBar& bar, const StopRequest& stop, std::string interrupted) {
  return [&bar, &stop, interrupted = std::move(interrupted),
          shown = std::string()](const ConvertProgress& progress) mutable {
    if (stop.requested()) throw Error(interrupted);
    if (const std::string now = label(progress); now != shown) bar.begin(shown = now, progress.bytes);
    bar.show(progress.share);
  };
}

}  // namespace umbrick::tools
