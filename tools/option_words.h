// The words of the library's options, in those of the command line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "command.h"
#include "umbrick/convert/options_error.h"

namespace umbrick::tools {

/// What the program says of options that do not fit: "x.nvdb: --codec is for .vdb" of "x.nvdb: output.codec is for
/// .vdb".
std::string inOptionWords(const OptionsError& error);

/// Does a job of the library. What it says of options becomes wrong usage. @throw UsageError
template <class Job>
auto asUsage(const Job& job) try {
  return job();
} catch (const OptionsError& error) {
  throw UsageError(inOptionWords(error));
}

}  // namespace umbrick::tools
