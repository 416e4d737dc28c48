// umbrick completion prints what makes a shell complete the program's command line.
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <string>

#include "command.h"
#include "command_tree.h"
#include "shell_scripts.h"
#include "umbrick/core/names.h"

namespace umbrick::tools {
namespace {

using Script = std::string (*)(const CommandNode&);
constexpr Name<Script> kShells[]{{"bash", bashScript}, {"zsh", zshScript}, {"fish", fishScript}};

}  // namespace

Command addCompletion(CLI::App& app) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "Print the completion of the command line for a shell.");
  sub->add_option("shell", *shell, "bash, zsh or fish; bash reads it by: source <(umbrick completion bash)")
      ->required()
      ->check(CLI::IsMember(listNames(kShells)));
  return {sub, [shell, &app] {
            std::cout << parseName(kShells, *shell, "shell")(describeCommands(app));
            return 0;
          }};
}

}  // namespace umbrick::tools
