// SPDX-License-Identifier: Apache-2.0
#include "command_tree.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "command_line.h"
#include "umbrick/core/axis.h"
#include "umbrick/core/names.h"
#include "umbrick/optics/transfer_function.h"
#include "umbrick/render/orientation.h"
#include "umbrick/study/study_plan.h"

namespace umbrick::tools {
namespace {

std::vector<std::string> splitWords(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

// The words of a kind that help names and does not list.
std::vector<std::string> wordsOf(const std::string& type) {
  std::vector<std::string> words;
  if (type == kPresetOrPath) {
    words = transferPresets();
    words.insert(words.begin(), "auto");
  } else if (type == kAxisType) {
    words = listNames(kAxes);
  } else if (type == kViewType) {
    words = viewNames();
  } else if (type == kMethodType) {
    for (const StudyMethod& method : studyMethods()) words.push_back(method.name);
  }
  return words;
}

// CLI11 tells the words of a value in the name of its type, "TEXT:{a,b}", and a range behind a colon, too.
ValueKind describeValue(const CLI::Option& option) {
  ValueKind kind;
  const std::string type = option.get_type_name();
  const std::size_t open = type.find(":{");
  if (open != std::string::npos && type.back() == '}') {
    kind.words = splitWords(type.substr(open + 2, type.size() - open - 3), ',');
    return kind;
  }
  kind.name = type.substr(0, type.find(':'));
  kind.words = wordsOf(kind.name);
  const std::vector<std::string> kinds = splitWords(kind.name, '|');
  kind.path = std::find(kinds.begin(), kinds.end(), "PATH") != kinds.end();
  return kind;
}

std::vector<std::string> sortedNames(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

OptionNode describeOption(const CLI::Option& option) {
  OptionNode node;
  if (option.get_positional())
    node.argument = option.get_name(true);
  else {
    for (const std::string& name : option.get_snames()) node.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) node.names.push_back("--" + name);
  }
  node.help = option.get_description();
  node.group = option.get_group();
  node.required = option.get_required();
  const bool isList = option.get_items_expected_max() >= CLI::detail::expected_max_vector_size;
  node.repeats = isList;
  if (option.get_type_size() != 0) {
    node.value = describeValue(option);
    node.preset = option.get_default_str();
    node.least = option.get_items_expected_min();
    node.most = option.get_items_expected_max();
    if (isList) node.most = option.get_allow_extra_args() ? kAnyNumber : std::max(1, option.get_type_size_min());
    node.delimiter = option.get_delimiter();
  }
  node.needs = sortedNames(option.get_needs());
  node.excludes = sortedNames(option.get_excludes());
  return node;
}

CommandNode describeCommand(const CLI::App& app, const std::vector<std::string>& path) {
  CommandNode node;
  node.path = path;
  node.about = app.get_description();
  // As help has them: what stands by its place first, then group by group.
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional()) node.options.push_back(describeOption(*option));
  for (const std::string& group : app.get_groups())
    for (const CLI::Option* option : app.get_options())
      if (!group.empty() && !option->get_positional() && option->get_group() == group)
        node.options.push_back(describeOption(*option));
  for (const CLI::App* command : app.get_subcommands({})) {
    std::vector<std::string> below = path;
    below.push_back(command->get_name());
    node.commands.push_back(describeCommand(*command, below));
  }
  return node;
}

}  // namespace

std::string CommandNode::name(const std::string& separator) const {
  std::string name = "umbrick";
  for (const std::string& word : path) name += separator + word;
  return name;
}

CommandNode describeCommands(const CLI::App& program) { return describeCommand(program, {}); }

std::vector<const CommandNode*> allCommands(const CommandNode& node) {
  std::vector<const CommandNode*> all{&node};
  for (const CommandNode& command : node.commands)
    for (const CommandNode* below : allCommands(command)) all.push_back(below);
  return all;
}

std::string joinedBy(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string briefHelp(const std::string& help, std::size_t most) {
  std::string brief = help.substr(0, help.find_first_of(";[\n"));
  while (!brief.empty() && (brief.back() == ' ' || brief.back() == '.')) brief.pop_back();
  if (brief.size() <= most) return brief;
  const std::size_t end = brief.rfind(' ', most - 3);
  brief.resize(end == std::string::npos ? most - 3 : end);
  return brief + "...";
}

}  // namespace umbrick::tools
