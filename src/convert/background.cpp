// SPDX-License-Identifier: Apache-2.0
#include "convert/background.h"

#include <sstream>

#include "umbrick/convert/options_error.h"

namespace umbrick {

bool keepsBackground(const BuildOptions& build, float background) {
  return build.clipBelow && background > *build.clipBelow && !(build.clipAbove && background > *build.clipAbove);
}

void refuseKept(const std::filesystem::path& input, const BuildOptions& build, float background, const char* whose) {
  if (!keepsBackground(build, background)) return;
  std::ostringstream text;
  text.precision(6);
  text << input.string() << ": build.background: what is left out lies below " << *build.clipBelow
       << " and would become " << background << ", " << whose << ", which lies above; give a background of at most "
       << *build.clipBelow;
  throw OptionsError(text.str());
}

}  // namespace umbrick
