// SPDX-License-Identifier: Apache-2.0
#include "shell_scripts.h"

#include <algorithm>

namespace umbrick::tools {
namespace {

// Text between single quotes, of bash and zsh and, with the quote itself behind a backslash, of fish.
std::string shellQuoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}
std::string fishQuoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out + "'";
}

// What _umbrick_offer takes, such as "2 path , a b": how many values, whether they are paths, a delimiter, words.
std::string bashValue(const OptionNode& option) {
  const std::string delimiter = option.delimiter ? std::string(1, option.delimiter) : "-";
  const std::string count = option.most == kAnyNumber ? "many" : std::to_string(option.most);
  std::string text = count + (option.value.path ? " path " : " word ") + delimiter;
  for (const std::string& word : option.value.words) text += ' ' + word;
  return text;
}

constexpr const char* kBashHead = R"(# bash completion of umbrick, made by umbrick completion bash.

# Offers the words that begin as the present one does, and files where $2 is path.
# $1: how many values an option takes, which is looked at before; $3: what stands between values in one word, or -; then the words
_umbrick_offer() {
  local kind=$2 delimiter=$3 done_part='' part=$cur
  shift 3
  if [ "$delimiter" != - ] && [[ $cur == *"$delimiter"* ]]; then
    done_part=${cur%"$delimiter"*}$delimiter
    part=${cur##*"$delimiter"}
  fi
  mapfile -t COMPREPLY < <(compgen -P "$done_part" -W "$*" -- "$part")
  if [ "$kind" = path ]; then
    local files
    mapfile -t files < <(compgen -f -- "$cur")
    [ ${#files[@]} -eq 0 ] || compopt -o filenames 2>/dev/null
    COMPREPLY+=("${files[@]}")
  fi
}

_umbrick() {
  local cur=${COMP_WORDS[COMP_CWORD]} words=() word i
  # bash cuts a word at an equals sign: --mode=mip is three words, of which the first two say what the third is.
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    [ "$word" = '=' ] || words+=("$word")
  done
  if [ "$cur" = '=' ]; then cur=''; fi
  COMPREPLY=()
  # The command is the words in front that are no options.
  local command='' stray=''
  for word in "${words[@]}"; do
    _umbrick_commands "$command"
    if [[ -z $word || " $REPLY " != *" $word "* ]]; then stray=$word; break; fi
    command+=${command:+ }$word
  done
  # The value of an option: the nearest one to the left, if it takes so many.
  local count value
  for ((i = ${#words[@]} - 1, count = 1; i >= 0; --i, ++count)); do
    [[ ${words[i]} == -?* ]] || continue
    _umbrick_options "$command"
    [[ " $REPLY " == *" ${words[i]} "* ]] || continue  # a negative number
    _umbrick_value "$command" "${words[i]}"
    value=$REPLY
    if [ "${value%% *}" = many ]; then
      if [ $count -eq 1 ] || [[ $cur != -* ]]; then
        # shellcheck disable=SC2086
        _umbrick_offer $value
        # The arguments of the command may follow, too.
        if [ $count -eq 1 ] || [ ${#COMPREPLY[@]} -gt 0 ]; then return 0; fi
      fi
    elif [ -n "$value" ] && [ "${value%% *}" -ge $count ]; then
      # shellcheck disable=SC2086
      _umbrick_offer $value
      return 0
    fi
    break
  done
  if [[ $cur == -* ]]; then
    _umbrick_options "$command"
    mapfile -t COMPREPLY < <(compgen -W "$REPLY" -- "$cur")
    return 0
  fi
  _umbrick_commands "$command"
  if [ -n "$REPLY" ]; then
    # No command follows a word that is none.
    if [[ -z $stray || $stray == -* ]]; then mapfile -t COMPREPLY < <(compgen -W "$REPLY" -- "$cur"); fi
    return 0
  fi
  _umbrick_value "$command" argument
  # shellcheck disable=SC2086
  [ -z "$REPLY" ] || _umbrick_offer $REPLY
}
)";

// A function of bash that answers by the command and an option, in REPLY.
std::string bashFunction(const std::string& name, const std::string& key, const std::string& cases) {
  return "\n" + name + "() {\n  case " + key + " in\n" + cases + "    *) REPLY='' ;;\n  esac\n}\n";
}
std::string bashCase(const std::string& key, const std::string& answer) {
  return "    " + shellQuoted(key) + ") REPLY=" + shellQuoted(answer) + " ;;\n";
}

// --- zsh ---

// A description between brackets, or a message between colons.
std::string zshText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

// ":PATH:_files"; behind every value that one use of an option takes.
std::string zshValue(const OptionNode& option) {
  const ValueKind& kind = option.value;
  std::string action;
  const std::string words = '(' + joinedBy(kind.words) + ')';
  if (option.delimiter && !kind.words.empty())
    action = std::string("_values -s ") + option.delimiter + " value " + joinedBy(kind.words);
  else if (kind.path && !kind.words.empty())
    // With a space in front, it is called with these words and no more.
    action = " _alternative \"words\\:word\\:" + words + "\" \"files\\:file\\:_files\"";
  else if (kind.path)
    action = "_files";
  else if (!kind.words.empty())
    action = words;
  else
    action = " ";
  return ":" + zshText(kind.name.empty() ? "value" : kind.name) + ":" + action;
}

std::string zshOption(const OptionNode& option) {
  if (option.isArgument()) {
    const std::string value = zshValue(option);
    return shellQuoted((option.most == kAnyNumber ? "*" : option.required ? "" : ":") + value);
  }
  std::string spec;
  if (option.repeats)
    spec = "'*'";
  else if (option.names.size() > 1)
    spec = shellQuoted('(' + joinedBy(option.names) + ')');
  std::vector<std::string> names;
  for (const std::string& name : option.names)
    names.push_back(option.isFlag() ? name : name + (name.starts_with("--") ? "=" : "+"));
  spec += names.size() > 1 ? '{' + joinedBy(names, ",") + '}' : names.front();
  std::string rest = '[' + zshText(briefHelp(option.help)) + ']';
  if (option.most == kAnyNumber)
    rest += zshValue(option);
  else
    for (int i = 0; i < option.most; ++i) rest += (i < option.least ? "" : ":") + zshValue(option);
  return spec + shellQuoted(rest);
}

std::string zshFunction(const CommandNode& node) { return '_' + node.name("_"); }

std::string zshCommand(const CommandNode& node) {
  std::string text = "\n" + zshFunction(node) + "() {\n";
  if (!node.commands.empty()) text += "  local context state state_descr line\n  typeset -A opt_args\n";
  text += "  _arguments -s -S";
  if (!node.commands.empty()) text += " -C";
  for (const OptionNode& option : node.options) text += " \\\n    " + zshOption(option);
  if (node.commands.empty()) return text + "\n}\n";
  text += " \\\n    ': :->command' \\\n    '*:: :->rest'\n  case $state in\n    command)\n      local -a commands=(\n";
  for (const CommandNode& command : node.commands)
    text += "        " + shellQuoted(command.path.back() + ':' + zshText(briefHelp(command.about))) + "\n";
  text += "      )\n      _describe -t commands command commands ;;\n    rest)\n      case $words[1] in\n";
  for (const CommandNode& command : node.commands)
    text += "        " + command.path.back() + ") " + zshFunction(command) + " ;;\n";
  return text + "      esac ;;\n  esac\n}\n";
}

// --- fish ---

std::string fishLine(const CommandNode& node, const std::string& rest) {
  return "complete -c umbrick -n '__umbrick_in " + joinedBy(node.path) + "' " + rest + "\n";
}

std::string fishOption(const CommandNode& node, const OptionNode& option) {
  std::string words;
  if (!option.value.words.empty()) {
    const std::string list = joinedBy(option.value.words);
    words = " -a " + (option.delimiter ? fishQuoted(std::string("(__fish_complete_list ") + option.delimiter +
                                                    " 'printf \"%s\\n\" " + list + "')")
                                       : fishQuoted(list));
  }
  const std::string files = option.value.path ? " -F" : " -f";
  if (option.isArgument()) return fishLine(node, (option.value.path ? "-F" : "-f") + words);
  std::string rest;
  for (const std::string& name : option.names)
    rest += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  rest.erase(0, 1);
  if (!option.isFlag()) rest += (option.least > 0 ? " -r" : "") + files + words;
  return fishLine(node, rest + " -d " + fishQuoted(briefHelp(option.help)));
}

}  // namespace

std::string bashScript(const CommandNode& program) {
  std::string commands, options, values;
  for (const CommandNode* node : allCommands(program)) {
    const std::string name = joinedBy(node->path);
    std::vector<std::string> below, names;
    for (const CommandNode& command : node->commands) below.push_back(command.path.back());
    if (!below.empty()) commands += bashCase(name, joinedBy(below));
    for (const OptionNode& option : node->options) {
      if (option.isArgument()) {
        values += bashCase(name + " argument", bashValue(option));
        continue;
      }
      for (const std::string& one : option.names) {
        names.push_back(one);
        if (!option.isFlag()) values += bashCase(name + ' ' + one, bashValue(option));
      }
    }
    options += bashCase(name, joinedBy(names));
  }
  return kBashHead + bashFunction("_umbrick_commands", "$1", commands) +
         bashFunction("_umbrick_options", "$1", options) + bashFunction("_umbrick_value", "\"$1 $2\"", values) +
         "\ncomplete -F _umbrick umbrick\n";
}

std::string zshScript(const CommandNode& program) {
  std::string text = "#compdef umbrick\n# zsh completion of umbrick, made by umbrick completion zsh.\n";
  for (const CommandNode* node : allCommands(program)) text += zshCommand(*node);
  // As an autoloaded function of a folder of $fpath, or read by source.
  return text +
         "\nif [ \"$funcstack[1]\" = \"_umbrick\" ]; then\n  _umbrick \"$@\"\nelse\n  compdef _umbrick umbrick\nfi\n";
}

std::string fishScript(const CommandNode& program) {
  std::string text = R"(# fish completion of umbrick, made by umbrick completion fish.

# Tells whether the command line begins with the words that are given, and none of their own commands follows.
function __umbrick_in
    set -l words (commandline -opc)
    set -e words[1]
    set -l command
    for word in $words
        contains -- "$command $word" $__umbrick_commands
        or break
        set command "$command $word"
    end
    set -l asked
    for word in $argv
        set asked "$asked $word"
    end
    test "$command" = "$asked"
end
)";
  std::string commands, lines;
  for (const CommandNode* node : allCommands(program)) {
    if (node != &program) commands += " ' " + joinedBy(node->path) + "'";
    lines += "\n";
    const bool takesPaths = std::any_of(node->options.begin(), node->options.end(), [](const OptionNode& option) {
      return option.isArgument() && option.value.path;
    });
    if (!takesPaths) lines += fishLine(*node, "-f");
    for (const CommandNode& command : node->commands)
      lines += fishLine(*node, "-a " + command.path.back() + " -d " + fishQuoted(briefHelp(command.about)));
    for (const OptionNode& option : node->options) lines += fishOption(*node, option);
  }
  return text + "set -g __umbrick_commands" + commands + "\n" + lines;
}

}  // namespace umbrick::tools
