// SPDX-License-Identifier: Apache-2.0
#include "convert/settle_options.h"

#include <string>

#include "umbrick/convert/options_error.h"

namespace umbrick {
namespace {

std::string wordOf(NanoValues values) {
  switch (values) {
    case NanoValues::bits4:
      return "bits4";
    case NanoValues::bits8:
      return "bits8";
    case NanoValues::bits16:
      return "bits16";
    case NanoValues::adaptive:
      return "adaptive";
    case NanoValues::float32:
      break;
  }
  return "float32";
}

// Half of the error is for what is left out and merged, half for what is quantised: left-out voxels in leaves are both.
void shareError(std::optional<float>& maxError, float& tolerance, NanoOptions& nano) {
  if (nano.values == NanoValues::adaptive) {
    if (nano.maxError > 0) return;
    if (!maxError) throw OptionsError("output.nano adaptive: expected a build.maxError to keep, found none");
    tolerance = nano.maxError = *maxError / 2;
    maxError.reset();
  } else if (maxError && nano.values != NanoValues::float32) {
    throw OptionsError("output.nano " + wordOf(nano.values) +
                       ": expected no build.maxError, which only output.nano adaptive can keep");
  }
}

}  // namespace

ConvertOptions settled(ConvertOptions options) {
  if (!options.output.nano) return options;
  NanoOptions& nano = *options.output.nano;
  shareError(options.build.maxError, options.build.tolerance, nano);
  if (options.isosurface && nano.values != NanoValues::float32)
    throw OptionsError(
        "options.isosurface: expected no output.nano, whose error is not that of a distance, found output.nano " +
        wordOf(nano.values));
  return options;
}

}  // namespace umbrick
