// What the command line offers, told apart from CLI11: commands, their options and the words that values can be. The
// manual and the completion of shells are made of it, so that they have all that the program has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace umbrick::tools {

/// What a value may be.
struct ValueKind {
  std::string name;                // as help calls it: "PATH", "FLOAT", "PRESET|PATH"; empty where there are only words
  std::vector<std::string> words;  // some or, where the name is empty, all that it can be
  bool path = false;               // of a file or a folder
};

/// An option, or where it has no names an argument that is told by its place.
struct OptionNode {
  std::vector<std::string> names;  // "-o", "--output"
  std::string argument;            // what an argument is called: "input"
  std::string help, group;
  ValueKind value;
  std::string preset;  // the default; empty: none that help tells
  int least = 0;       // values that one use takes; 0 and 0: a flag
  int most = 0;        // kAnyNumber: as many as follow
  bool required = false;
  bool repeats = false;  // may be given more than once
  char delimiter = 0;    // between values in one word; 0: none
  std::vector<std::string> needs, excludes;

  bool isArgument() const { return names.empty(); }
  bool isFlag() const { return most == 0; }
};
inline constexpr int kAnyNumber = 1 << 20;

/// A command, or the program itself.
struct CommandNode {
  std::vector<std::string> path;  // "tf", "list"; empty: the program itself
  std::string about;
  std::vector<OptionNode> options;  // in the order of the help
  std::vector<CommandNode> commands;

  /// Returns the words of the path: "umbrick-tf-list" for "-".
  std::string name(const std::string& separator) const;
};

/// Returns the commands of a program, each with all that its help lists.
CommandNode describeCommands(const CLI::App& program);

/// Returns the node and all below it, each before its own commands.
std::vector<const CommandNode*> allCommands(const CommandNode& node);

/// "a b c", with what stands between them.
std::string joinedBy(const std::vector<std::string>& words, const std::string& separator = " ");

/// Returns the first part of a help text, for a list that has one line an option: up to a semicolon, a bracket or
/// `most` characters, whatever is first.
std::string briefHelp(const std::string& help, std::size_t most = 76);

}  // namespace umbrick::tools
