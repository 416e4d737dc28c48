// Runs the umbrick program as a user would.
#pragma once
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/files.h"
#include "support/temporary_folder.h"

namespace umbrick {

/// The bundled smoke, as an argument.
inline const std::string kSmoke = "'" UMBRICK_ASSETS "/densityAndHeat.vdb' ";

struct ProgramResult {
  int status = -1;  // exit status; 128 + signal when it was killed
  std::string out, err;
};

/// @param arguments  as typed into a shell, in `folder`
inline ProgramResult runProgram(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string at = folder.path().string();
  const int raw = std::system(("cd '" + at + "' && '" UMBRICK_PROGRAM "' " + arguments + " >.out 2>.err").c_str());
  ProgramResult result;
  result.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  result.out = readBytes(folder.path() / ".out");
  result.err = readBytes(folder.path() / ".err");
  std::filesystem::remove(folder.path() / ".out");
  std::filesystem::remove(folder.path() / ".err");
  return result;
}

inline std::size_t filesIn(const TemporaryFolder& folder) {
  using Iterator = std::filesystem::directory_iterator;
  return static_cast<std::size_t>(std::distance(Iterator(folder.path()), Iterator()));
}

}  // namespace umbrick
