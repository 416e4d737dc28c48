// The words of the library's options, in those of the command line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <exception>
#include <string>

#include "umbrick/convert/options_error.h"
#include "umbrick/render/asked_scene.h"
#include "usage_error.h"

namespace umbrick::tools {

/// What the program says of options that do not fit: "x.nvdb: --codec is for .vdb" of "x.nvdb: output.codec is for
/// .vdb".
std::string inOptionWords(const OptionsError& error);

/// What the program says of any other error: the message, with the option that sets the field which it begins with
/// ("bricks.budgetMiB (--memory-budget): ..."), and the option that helps.
std::string inOptionWords(const std::exception& error);

/// Does a job of the library. What it says of options becomes wrong usage. @throw UsageError
template <class Job>
auto asUsage(const Job& job) try {
  return job();
} catch (const OptionsError& error) {
  throw UsageError(inOptionWords(error));
} catch (const AskedSceneError& error) {
  throw UsageError(error.what());
}

}  // namespace umbrick::tools
