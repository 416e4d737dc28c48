// SPDX-License-Identifier: Apache-2.0
#include "convert/check_verified.h"

#include <cstdio>

#include "umbrick/core/error.h"

namespace umbrick {

void checkVerified(const std::filesystem::path& output, const std::string& label, const VerifyReport& seen,
                   const BuildReport& stated) {
  if (seen.honours(stated)) return;
  char line[320];
  std::snprintf(line, sizeof line,
                "expected at most a maximum error of %.9g and an RMS of %.9g, found %.9g and %.9g; %llu voxels that "
                "should be background are not, %llu are beyond the volume; nothing was written",
                stated.maxError, stated.rmsError, seen.error.max, seen.error.rms,
                static_cast<unsigned long long>(seen.wrongly), static_cast<unsigned long long>(seen.beyond));
  throw Error(output.string() + ": grid \"" + label + "\": verification failed: " + line);
}

}  // namespace umbrick
