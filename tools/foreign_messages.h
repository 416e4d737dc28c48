// Keeps what foreign libraries print away from stderr, which is for the program's own lines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <streambuf>
#include <string>

namespace umbrick::tools {

/// The descriptor that the program's own messages go to: stderr as the user gave it.
int messageDescriptor();

/// While an object of this class lives, what is written to stderr by its descriptor or by stdio is caught: Mesa, EGL,
/// HDF5, OpenJPEG and others print there, and so does the C library where it gives up. std::cerr goes on to the user's
/// stderr, and its control characters become \xNN, so that no name and no header is obeyed by a terminal.
///
/// What ends the program by a signal still says why: what was caught is printed then. Where the address space is used
/// up it is one line on that, with exit status 1, since libraries that are refused memory end so.
class ForeignMessages {
 public:
  ForeignMessages();
  /// Says in one line what was caught, unless it has been taken. What is written later, as the process ends, is lost.
  ~ForeignMessages();
  ForeignMessages(const ForeignMessages&) = delete;
  ForeignMessages& operator=(const ForeignMessages&) = delete;

  /// What was caught so far, shortened to a part of a line: `; libraries say: "..." and 6 more lines`. Empty where
  /// nothing was.
  std::string take();

 private:
  std::unique_ptr<std::streambuf> buffer_;
  std::streambuf* before_ = nullptr;
};

/// Names what the program does, for the line that is said where it must end: the sub-command and its input.
void nameJob(const std::string& job);
/// The same name, for messages.
std::string jobName();

}  // namespace umbrick::tools
