// SPDX-License-Identifier: Apache-2.0
#include "study_page/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <vector>

#include "umbrick/core/error.h"

extern char** environ;

namespace umbrick::tools {
namespace {

struct Outcome {
  int status = -1;     // of wait; -1: the program could not be started
  int error = 0;       // errno in that case
  std::string output;  // stdout and stderr
};

// Runs a program without a shell, so that no name needs quoting.
Outcome run(std::vector<std::string> arguments, const std::filesystem::path& folder) {
  Outcome outcome;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw IoError(std::string("gnuplot: no pipe: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  // This program ignores some signals, which another one takes as it finds them.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t ignored;
  sigemptyset(&ignored);
  sigaddset(&ignored, SIGPIPE);
  sigaddset(&ignored, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &ignored);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  outcome.error = posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (outcome.error == 0) {
    std::array<char, 4096> block;
    ssize_t count = 0;
    while ((count = read(ends[0], block.data(), block.size())) > 0 || (count < 0 && errno == EINTR))
      if (count > 0) outcome.output.append(block.data(), static_cast<std::size_t>(count));
    while (waitpid(child, &outcome.status, 0) < 0 && errno == EINTR) {
    }
  }
  close(ends[0]);
  return outcome;
}

// Returns the last line that is not empty: gnuplot prints the place, shows the line, then says what is wrong.
std::string lastLine(std::string text) {
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  const std::size_t begin = text.find_last_of('\n');
  text = begin == std::string::npos ? text : text.substr(begin + 1);
  return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
}

bool succeeded(const Outcome& outcome) {
  return outcome.error == 0 && WIFEXITED(outcome.status) && WEXITSTATUS(outcome.status) == 0;
}

std::string reason(const Outcome& outcome) {
  if (outcome.error != 0) return std::strerror(outcome.error);
  if (WIFSIGNALED(outcome.status)) return "ended by signal " + std::to_string(WTERMSIG(outcome.status));
  const std::string said = lastLine(outcome.output);
  return said.empty() ? "exit status " + std::to_string(WEXITSTATUS(outcome.status)) : said;
}

}  // namespace

std::string gnuplotVersion() {
  const Outcome outcome = run({"gnuplot", "-e", "set terminal svg; print GPVAL_VERSION"}, {});
  if (!succeeded(outcome))
    throw IoError("gnuplot: cannot be run (" + reason(outcome) + "); the plots need it: Debian package gnuplot-nox");
  return "gnuplot " + lastLine(outcome.output);
}

void runGnuplot(const std::filesystem::path& script) {
  const Outcome outcome = run({"gnuplot", script.filename().string()}, script.parent_path());
  if (!succeeded(outcome)) throw IoError(script.string() + ": gnuplot failed: " + reason(outcome));
}

}  // namespace umbrick::tools
