// SPDX-License-Identifier: Apache-2.0
#include "manual_page.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <string_view>
#include <utility>

namespace umbrick::tools {
namespace {

// What a command line does, as an example that a page shows. A test runs those that end by themselves.
struct Example {
  std::string_view command;  // as its page is called, "tf list"; empty: the program
  std::string_view what, line;
};

// The files are those of the folder of examples that the packages bring.
constexpr Example kExamples[] = {
    {"", "Make a picture of a volume. What is chosen is said, as options to change:",
     "umbrick render densityAndHeat.vdb -o smoke.png"},
    {"convert", "Make a sparse grid of headerless voxels, and read it back before it takes its name:",
     "umbrick convert headsq_256x256x94_uint16le.raw.gz --dims 256 256 94 --type u16 --bits-stored 15 "
     "--spacing 0.8 0.8 1.5 --verify -o head.vdb"},
    {"convert", "Leave out what is near the background, and be off by no more than 0.01:",
     "umbrick convert densityAndHeat.vdb --grid density --max-error 0.01 -o small.nvdb"},
    {"info", "List the grids of a file:", "umbrick info densityAndHeat.vdb"},
    {"render", "See smoke from above, with occlusion:",
     "umbrick render densityAndHeat.vdb --tf smoke --view top --model cone --theta 60 -o smoke.png"},
    {"render", "Average pictures until the estimated error is small, or ten seconds are over:",
     "umbrick render densityAndHeat.vdb --size 128x128 --target-error 0.05 --max-seconds 10 -o smoke.exr"},
    {"render", "Show the largest value along each ray:", "umbrick render densityAndHeat.vdb --mode mip -o largest.png"},
    {"reference", "Integrate the same scene in double precision, on few pixels:",
     "umbrick reference densityAndHeat.vdb --tf smoke --model emission --size 32x32 -o truth.exr"},
    {"compare", "Say how far one picture is from another:", "umbrick compare smoke.png smoke.png --max-rmse 0.01"},
    {"check", "Prove that bricks change nothing:", "umbrick check densityAndHeat.vdb --tf smoke --size 32x32"},
    {"study", "Say what accuracy costs on this scene, as a page:",
     "umbrick study densityAndHeat.vdb --tf smoke --quick -o report"},
    {"tf list", "List the presets:", "umbrick tf list"},
    {"tf auto",
     "Write the function that render chooses, to be edited:", "umbrick tf auto densityAndHeat.vdb -o mine.json"},
    {"view", "Look at a volume in a browser, until Ctrl-C:", "umbrick view densityAndHeat.vdb"},
    {"completion", "Complete the command line of this shell:", "source <(umbrick completion bash)"},
    {"manual", "Read a page that is not installed:", "umbrick manual render | man -l -"},
};

// Texts of troff. A hyphen that is to be typed is a minus; a line that begins with a dot or a quote would be a request.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\n') {
      out += "\n.br\n";
    } else {
      if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
      out += c;
    }
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text) + "\\fR"; }

// "auto|cpu", or "PATH PATH"
std::string valueOf(const OptionNode& option) {
  const ValueKind& kind = option.value;
  const std::string one = italic(kind.name.empty() ? joinedBy(kind.words, "|") : kind.name);
  if (option.most == kAnyNumber) return one + " ...";
  std::string text;
  for (int i = 0; i < std::max(1, option.least); ++i) text += (i == 0 ? "" : " ") + one;
  return text;
}

// What a page says of an option behind its name.
std::string bodyOf(const OptionNode& option) {
  std::string text = escaped(option.help) + "\n";
  const auto add = [&](const std::string& more) { text += ".br\n" + more + "\n"; };
  if (!option.value.name.empty() && !option.value.words.empty()) {
    std::vector<std::string> words;
    for (const std::string& word : option.value.words) words.push_back(bold(word));
    add("Names: " + joinedBy(words, ", ") + ".");
  }
  if (!option.preset.empty()) add("Default: " + bold(option.preset) + ".");
  if (option.required) add("Required.");
  const auto addNames = [&](const char* title, const std::vector<std::string>& names) {
    std::vector<std::string> all;
    for (const std::string& name : names) all.push_back(bold(name));
    if (!all.empty()) add(title + joinedBy(all, ", ") + ".");
  };
  addNames("Only with ", option.needs);
  addNames("Not with ", option.excludes);
  return text;
}

std::string entryOf(const OptionNode& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back(bold(name));
  std::string head = option.isArgument() ? italic(option.argument) : joinedBy(names, ", ");
  if (!option.isArgument() && !option.isFlag()) head += ' ' + valueOf(option);
  return ".TP\n" + head + "\n" + bodyOf(option);
}

std::string synopsisOf(const CommandNode& node) {
  std::string text = bold(node.name(" "));
  for (const OptionNode& option : node.options) {
    if (!option.isArgument()) continue;
    const std::string argument = italic(option.argument) + (option.most == kAnyNumber ? " ..." : "");
    text += option.required ? ' ' + argument : " [" + argument + ']';
  }
  for (const OptionNode& option : node.options)
    if (option.required && !option.isArgument()) text += ' ' + bold(option.names.front()) + ' ' + valueOf(option);
  text += " [" + italic("options") + "]";
  if (!node.commands.empty()) text += ' ' + italic("command") + " ...";
  return text + "\n";
}

std::string optionsOf(const CommandNode& node) {
  std::string text, group;
  bool arguments = false;
  for (const OptionNode& option : node.options)
    if (option.isArgument()) {
      text += (arguments ? "" : ".SH ARGUMENTS\n") + entryOf(option);
      arguments = true;
    }
  text += ".SH OPTIONS\n";
  for (const OptionNode& option : node.options) {
    if (option.isArgument()) continue;
    if (option.group != group && option.group != "Options") text += ".SS " + escaped(option.group) + "\n";
    group = option.group;
    text += entryOf(option);
  }
  return text;
}

// "list the presets": what a command does, as the end of a line.
std::string lowered(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  while (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

std::string examplesOf(const CommandNode& node) {
  std::string name = node.name(" ");
  name.erase(0, std::min(name.size(), std::string_view("umbrick ").size()));
  std::string text;
  for (const Example& example : kExamples)
    if (example.command == name)
      text += (text.empty() ? ".SH EXAMPLES\n" : "") + std::string(".PP\n") + escaped(example.what) +
              "\n.PP\n.nf\n.RS 4\n" + escaped(example.line) + "\n.RE\n.fi\n";
  return text;
}

constexpr std::string_view kCommon = R"(.SH EXIT STATUS
.TP
.B 0
success
.TP
.B 1
a failed job, check or comparison, of which a line on stderr says what is wrong
.TP
.B 2
wrong usage
.PP
Data goes to stdout and messages to stderr. A failed command leaves no partial file.
.SH ENVIRONMENT
.TP
.B UMBRICK_PROGRESS
.B none
silences how far a long job is, and
.B steps
writes a line for each tenth of each of its parts at once.
.TP
.B TMPDIR
where a conversion to stdout is kept until it is verified.
)";

}  // namespace

std::string manualPage(const CommandNode& node, const CommandNode& program, const std::string& version) {
  std::string title = node.name("-");
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  // No date: the page is the same whenever it is made.
  std::string page = ".\\\" Made by umbrick manual of the program's own options.\n.TH " + escaped(title) +
                     " 1 \"\" \"" + escaped(version) + "\" \"User Commands\"\n";
  page += ".SH NAME\n" + escaped(node.name("-")) + " \\- " + escaped(lowered(node.about)) + "\n";
  page += ".SH SYNOPSIS\n" + synopsisOf(node) + ".SH DESCRIPTION\n" + escaped(node.about) + "\n";
  if (!node.commands.empty()) {
    page += ".SH COMMANDS\n";
    for (const CommandNode& command : node.commands)
      page += ".TP\n" + bold(command.path.back()) + "\n" + escaped(lowered(command.about)) + ":\n.BR " +
              escaped(command.name("-")) + " (1)\n";
  }
  page += optionsOf(node) + examplesOf(node);
  page += kCommon;
  page += ".SH SEE ALSO\n";
  std::string others;
  for (const CommandNode* other : allCommands(program))
    if (other != &node)
      others += (others.empty() ? "" : " ,\n") + std::string(".BR ") + escaped(other->name("-")) + " (1)";
  return page + others + "\n";
}

}  // namespace umbrick::tools
