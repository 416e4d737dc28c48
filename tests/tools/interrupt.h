// Interrupts the umbrick program while it works, as Ctrl-C does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <signal.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <string>
#include <system_error>

#include "tools/program.h"

namespace umbrick {

/// Tells whether a process is the program, and handles SIGINT by itself. Until it does, an interrupt ends it as any
/// other process. The shell that it was before handles SIGINT too.
inline bool catchesInterrupt(pid_t pid) {
  const std::filesystem::path process = "/proc/" + std::to_string(pid);
  std::error_code gone;
  if (std::filesystem::read_symlink(process / "exe", gone) != std::filesystem::canonical(UMBRICK_PROGRAM)) return false;
  std::ifstream status(process / "status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:")) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
  return false;
}

/// Runs the program and interrupts it once it is prepared for that and `ready` holds. However slow the machine is, the
/// interrupt comes neither before nor after the work if there is enough work.
/// @param shell  what runs the file .run, which becomes the program, in `folder`
inline ProgramResult interruptProgram(
    const TemporaryFolder& folder, const std::string& arguments,
    const std::function<bool()>& ready = [] { return true; }, const std::string& shell = "sh .run") {
  const auto in = [&](const char* name) { return folder.path() / name; };
  writeBytes(in(".run"), "echo $$ >.pid\nexec '" UMBRICK_PROGRAM "' " + arguments + "\n");
  const std::string command = "cd '" + folder.path().string() + "' && UMBRICK_PROGRESS=none " + shell + " >.out 2>.err";
  std::future<int> run = std::async(std::launch::async, [&] { return std::system(command.c_str()); });
  const auto waitUntil = [&](const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition() && std::chrono::steady_clock::now() < end)
      if (run.wait_for(std::chrono::milliseconds(5)) == std::future_status::ready) break;
    return condition();
  };
  pid_t pid = 0;
  const bool started = waitUntil([&] {
    const std::string text = readBytes(in(".pid"));
    if (text.ends_with('\n')) pid = std::stoi(text);
    return pid > 0 && catchesInterrupt(pid);
  });
  const bool prepared = started && waitUntil(ready);
  const bool ended = run.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (pid > 0 && !ended) ::kill(pid, prepared ? SIGINT : SIGKILL);
  const ProgramResult result = takeResult(folder, run.get());
  for (const char* name : {".run", ".pid"}) std::filesystem::remove(in(name));
  CAPTURE(arguments, result.err);
  REQUIRE(prepared);
  REQUIRE_FALSE(ended);
  return result;
}

}  // namespace umbrick
