// What stands where a file is to be written, which decides how it is written there.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

enum class OutputKind {
  file,    // a regular file, or nothing yet: replaced whole
  stream,  // a pipe, a FIFO, a terminal or another device: written through, once all of it is known
};

/// A regular file that is to be replaced.
struct StandingFile {
  std::uint32_t mode = 0, user = 0, group = 0;  // as stat has them; the mode without the type
  std::uint64_t names = 1;                      // hard links
};

struct Output {
  std::filesystem::path given;  // as messages name it
  std::filesystem::path path;   // of a file: where it is, with symbolic links followed
  OutputKind kind = OutputKind::file;
  int descriptor = -1;                     // of a stream that this process has open, such as /dev/stdout
  std::optional<StandingFile> standing{};  // what a file replaces, if anything

  bool isStream() const { return kind == OutputKind::stream; }
};

/// A stream whose reader has gone, which is no fault of the writer.
struct PipeClosed : IoError {
  using IoError::IoError;
};

/// Looks at what is there and opens nothing. A symbolic link is followed, also one whose target does not exist yet.
/// /dev/stdout, /dev/fd/N and the like are the descriptor of that number, also where it is a regular file: what the
/// caller has opened is not replaced.
/// @throw IoError  a folder, a disk (block device), a loop of links
Output outputAt(const std::filesystem::path& target);

/// Returns why a regular file should not be replaced without being asked: "is read-only", "belongs to another user".
/// The system may allow it all the same, since replacing a file asks for permission to its folder alone.
std::optional<std::string> whyProtected(const Output& output);

}  // namespace umbrick
