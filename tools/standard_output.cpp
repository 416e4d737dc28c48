// SPDX-License-Identifier: Apache-2.0
#include "standard_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace umbrick::tools {

void openStandardDescriptors() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    // It gets the lowest number that is free, which is this one. Nobody can write to what is open to be read.
    const int opened = open("/dev/null", O_RDONLY);
    if (opened >= 0 && opened != number) close(opened);
  }
}

StandardOutput::StandardOutput() : buffer_(STDOUT_FILENO, "stdout"), before_(std::cout.rdbuf(&buffer_)) {
  if (isatty(STDOUT_FILENO) == 1) std::cout << std::unitbuf;
}

StandardOutput::~StandardOutput() { std::cout.rdbuf(before_); }

void StandardOutput::finish() {
  buffer_.rethrow();
  buffer_.pubsync();
}

}  // namespace umbrick::tools
