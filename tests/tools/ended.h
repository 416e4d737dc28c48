// Ends the umbrick program by a signal while it works, and measures how long that takes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "tools/interrupt.h"
#include "tools/program.h"

namespace umbrick {

/// Starts the program. @param arguments  as typed into a shell, in `folder`
inline pid_t startProgram(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string script = "cd '" + folder.path().string() + "' && export UMBRICK_PROGRESS=none && exec '" +
                             UMBRICK_PROGRAM "' " + arguments + " >.out 2>.err";
  std::string shell = "sh", option = "-c", text = script;
  char* words[]{shell.data(), option.data(), text.data(), nullptr};
  // A child of fork would have Catch's handlers of signals for a moment. This returns when it is the shell.
  pid_t child = -1;
  REQUIRE(posix_spawn(&child, "/bin/sh", nullptr, nullptr, words, environ) == 0);
  return child;
}

/// Waits for the end of a program. @return what waitpid says of it
inline int waitFor(pid_t program) {
  int status = 0;
  while (waitpid(program, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Waits as long as a job needs to be amid its work.
inline std::function<bool()> after(double seconds) {
  const auto begin = std::chrono::steady_clock::now();
  return [=] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds; };
}

struct Ended {
  ProgramResult result;
  double seconds = 0;  // from the signal to the end
};

/// Runs the program, sends it a signal once it handles signals and `ready` holds, and waits for its end.
inline Ended endProgram(
    const TemporaryFolder& folder, const std::string& arguments, int number,
    const std::function<bool()>& ready = [] { return true; }) {
  using Clock = std::chrono::steady_clock;
  const pid_t program = startProgram(folder, arguments);
  const auto end = Clock::now() + std::chrono::minutes(2);
  bool prepared = false;
  while (!(prepared = catchesInterrupt(program) && ready()) && Clock::now() < end &&
         waitpid(program, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const auto begin = Clock::now();
  ::kill(program, prepared ? number : SIGKILL);
  const int status = waitFor(program);
  Ended ended{takeResult(folder, status), std::chrono::duration<double>(Clock::now() - begin).count()};
  CAPTURE(arguments, ended.result.err);
  REQUIRE(prepared);
  return ended;
}

/// How long a program may take to end. A second is promised; a busy machine may take many times as long, and what would
/// not stop takes minutes or waits for ever.
constexpr double kMostSeconds = 60;

}  // namespace umbrick
