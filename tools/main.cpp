// The umbrick program. Each sub-command has a file of its own beside this one.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "dist/ranks.h"
#include "foreign_messages.h"
#include "label_words.h"
#include "option_words.h"
#include "scene_options.h"
#include "standard_output.h"
#include "stop_request.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/output.h"
#include "umbrick/core/printable.h"
#include "volume_options.h"

namespace {
using namespace umbrick::tools;

// What is said to who types no more than the name. The exit status is that of wrong usage, since nothing was done.
constexpr const char* kGreeting =
    "umbrick " UMBRICK_VERSION
    ": converts, shows, renders, compares and checks sparse volumes\n"
    "  umbrick render INPUT -o picture.png   makes a picture of a volume\n"
    "  umbrick --help                        lists the commands; umbrick render --help says more of one\n";

// Returns the command line with a background's name in place of its three numbers, for the sub-commands that have such.
std::vector<std::string> spelledOut(std::vector<std::string> words, const std::vector<Command>& commands) {
  for (const auto& [command, run] : commands) {
    if (words.empty() || command->get_name() != words.front()) continue;
    const CLI::Option* background = command->get_option_no_throw("--background");
    if (background && background->get_expected_min() == 3) return spellOutBackground(std::move(words));
  }
  return words;
}

// "render head.nii", for messages of what ends in the middle.
std::string jobOf(const CLI::App& command) {
  std::string job = command.get_name();
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional() && !option->results().empty()) return job + ' ' + option->results().front();
  return job;
}

// Returns the exit status: 0 success, 1 a failed job or comparison, 2 wrong usage.
int runProgram(int argc, char** argv, Ranks& ranks) {
  if (argc <= 1) {
    std::cerr << kGreeting;
    return 2;
  }
  CLI::App app{"Sparse volumes: convert, inspect, render, compare, check.", "umbrick"};
  app.set_version_flag("--version", "umbrick " UMBRICK_VERSION);
  app.require_subcommand(1);
  // A message is one line, like every other error.
  app.failure_message(
      [](const CLI::App*, const CLI::Error& error) { return std::string("umbrick: ") + error.what() + "\n"; });
  const std::vector<Command> commands{
      addConvert(app), addInfo(app), addRender(app, ranks), addReference(app),  addCompare(app), addCheck(app),
      addStudy(app),   addTf(app),   addView(app),          addCompletion(app), addManual(app),
  };
  try {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    if (!arguments.empty() && arguments.front() != "convert") arguments = joinVectors(std::move(arguments));
    arguments = spelledOut(completeLabels(std::move(arguments)), commands);
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : 2;
  }
  for (const auto& [command, run] : commands)
    if (command->parsed()) {
      nameJob(jobOf(*command));
      if (!ranks.isAlone() && command->get_name() != "render")
        throw UsageError(command->get_name() + ": is for one process, found " + std::to_string(ranks.count()) +
                         " ranks of mpirun, which share the work of umbrick render");
      return run();
    }
  return 2;
}

// Ends quietly, as every program does whose reader has gone: by the signal that was ignored so far.
int endByClosedPipe() {
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
  return 1;
}

// Runs the program, and says what went wrong and what libraries printed.
int runAndTell(int argc, char** argv) {
  StandardOutput out;
  ForeignMessages foreign;
  std::unique_ptr<Ranks> ranks;
  const auto complain = [&](const std::string& message, int exitStatus) {
    if (!ranks || ranks->isFirst())
      std::cerr << "umbrick: " << umbrick::printable(message) << foreign.take() << '\n';
    else if (stopRequested())
      ranks->stop();  // as all ranks do, of which the first one says it
    else
      ranks->fail(umbrick::printable(message) + foreign.take());
    return exitStatus;
  };
  int status = 0;
  try {
    try {
      ranks = joinRanks(messageDescriptor());
      status = umbrick::withinMemory(jobName, [&] { return runProgram(argc, argv, *ranks); });
    } catch (const umbrick::PipeClosed&) {
      throw;
    } catch (const UsageError& error) {
      status = complain(error.what(), 2);
    } catch (const std::exception& error) {
      status = complain(inOptionWords(error), 1);
    }
    out.finish();
  } catch (const umbrick::PipeClosed&) {
    return endByClosedPipe();
  } catch (const umbrick::IoError& error) {
    return complain(error.what(), std::max(status, 1));
  }
  if (!ranks || ranks->isAlone()) return status;
  // Ranks leave together, after the last one has done.
  if (stopRequested()) endsByItself();
  const bool first = ranks->isFirst();
  ranks.reset();
  foreign.take();             // what MPI says as it ends
  return first ? status : 0;  // of the others mpirun would take it for a reason to end all
}

}  // namespace

int main(int argc, char** argv) {
  openStandardDescriptors();
  const SignalWatch signals;
  const int status = runAndTell(argc, argv);
  leaveIfStopped(status);
  return status;
}
