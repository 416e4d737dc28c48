// umbrick manual prints the pages of the manual.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "command_tree.h"
#include "manual_page.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct ManualCommand {
  std::vector<std::string> words;
  fs::path folder;
};

const CommandNode& findCommand(const CommandNode& program, const std::vector<std::string>& path) {
  std::string names;
  for (const CommandNode* node : allCommands(program)) {
    if (node->path == path) return *node;
    std::string name = node->name(" ");
    if (node != &program) names += (names.empty() ? "" : ", ") + name.substr(std::string("umbrick ").size());
  }
  std::string asked;
  for (const std::string& word : path) asked += (asked.empty() ? "" : " ") + word;
  throw UsageError("manual: expected one of " + names + ", found '" + asked + "'");
}

int printManual(const ManualCommand& command, const CLI::App& app) {
  const CommandNode program = describeCommands(app);
  const std::string version = "umbrick " UMBRICK_VERSION;
  if (command.folder.empty()) {
    std::cout << manualPage(findCommand(program, command.words), program, version);
    return 0;
  }
  if (!command.words.empty()) throw UsageError("manual: --folder is for all pages, found a command, too");
  fs::create_directories(command.folder);
  for (const CommandNode* node : allCommands(program))
    writeTextFile(command.folder / (node->name("-") + ".1"), manualPage(*node, program, version));
  return 0;
}

}  // namespace

Command addManual(CLI::App& app) {
  const auto command = std::make_shared<ManualCommand>();
  CLI::App* sub = app.add_subcommand("manual", "Print a page of the manual, for man -l.");
  sub->add_option("command", command->words, "whose page: render, or tf list [that of the program]");
  sub->add_option("--folder", command->folder, "write all pages into this folder, which is made where it is missing");
  return {sub, [command, &app] { return printManual(*command, app); }};
}

}  // namespace umbrick::tools
