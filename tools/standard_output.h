// What the program prints to stdout, which is data: it arrives whole, or the program says that it did not.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iostream>

#include "core/descriptor.h"

namespace umbrick::tools {

/// Opens what is closed of stdin, stdout and stderr, so that no file of a job gets their numbers. What is written to a
/// stdout that was closed is an error all the same.
void openStandardDescriptors();

/// Collects what std::cout is given, while an object of this class lives.
class StandardOutput {
 public:
  StandardOutput();
  ~StandardOutput();
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;
  /// Writes what is left. @throw PipeClosed, IoError  also when something could not be written before
  void finish();

 private:
  DescriptorBuffer buffer_;
  std::streambuf* before_;
};

}  // namespace umbrick::tools
