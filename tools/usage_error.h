// Wrong usage of the umbrick program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>

namespace umbrick::tools {

/// An error of usage that CLI11 cannot see, such as options that exclude each other. The exit status is 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace umbrick::tools
