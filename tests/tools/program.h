// Runs the umbrick program as a user would.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/files.h"
#include "support/temporary_folder.h"

namespace umbrick {

/// A bundled volume, as an argument.
inline const std::string kSmoke = "'" UMBRICK_ASSETS "/densityAndHeat.vdb' ";
inline const std::string kHead =
    "'" UMBRICK_ASSETS "/headsq_256x256x94_uint16le.raw.gz' --dims 256 256 94 --type u16 --bits-stored 15 ";

struct ProgramResult {
  int status = -1;  // exit status; 128 + signal when it was killed
  std::string out, err;
};

inline int exitStatus(int waited) { return WIFEXITED(waited) ? WEXITSTATUS(waited) : 128 + WTERMSIG(waited); }

/// Reads the files .out and .err of a run that is over, and removes them.
inline ProgramResult takeResult(const TemporaryFolder& folder, int waited) {
  ProgramResult result{exitStatus(waited), readBytes(folder.path() / ".out"), readBytes(folder.path() / ".err")};
  std::filesystem::remove(folder.path() / ".out");
  std::filesystem::remove(folder.path() / ".err");
  return result;
}

/// Runs the program.
/// @param arguments    as typed into a shell, in `folder`
/// @param environment  variables; a job says nothing of its progress, however long it takes on a busy machine
inline ProgramResult runProgram(const TemporaryFolder& folder, const std::string& arguments,
                                const std::string& environment = "UMBRICK_PROGRESS=none") {
  const std::string at = folder.path().string();
  const std::string command = "cd '" + at + "' && " + environment + " '" UMBRICK_PROGRAM "' " + arguments;
  const int raw = std::system((command + " >.out 2>.err").c_str());
  return takeResult(folder, raw);
}

/// Runs a shell script in `folder`, which finds the program as $umbrick. @return what the script prints
inline ProgramResult runShell(const TemporaryFolder& folder, const std::string& script) {
  const std::string at = folder.path().string();
  const int raw = std::system(
      ("cd '" + at + "' && export UMBRICK_PROGRESS=none umbrick='" UMBRICK_PROGRAM "' && (" + script + ") >.out 2>.err")
          .c_str());
  return takeResult(folder, raw);
}

inline std::size_t filesIn(const TemporaryFolder& folder) {
  using Iterator = std::filesystem::directory_iterator;
  return static_cast<std::size_t>(std::distance(Iterator(folder.path()), Iterator()));
}

}  // namespace umbrick
