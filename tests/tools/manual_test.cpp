// The manual and the completion of shells have all that help has, and work.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tools/program.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

using Words = std::vector<std::string>;

bool hasProgram(const std::string& name) {
  if (std::system(("command -v " + name + " >/dev/null").c_str()) == 0) return true;
  std::cout << "SKIPPED: " << name << " is not installed\n";
  return false;
}

// The first word of each line that a pattern finds.
Words findAll(const std::string& text, const std::string& pattern) {
  Words found;
  const std::regex expression(pattern, std::regex::multiline);
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

Words linesOf(const std::string& text) {
  Words lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The commands that a help lists, with those below them: "", "render", "tf", "tf list".
void addCommands(const TemporaryFolder& folder, const std::string& command, Words& commands) {
  commands.push_back(command);
  const std::string help = runProgram(folder, command + " --help").out;
  const std::size_t list = help.find("\nSubcommands:\n");
  if (list == std::string::npos) return;
  for (const std::string& below : findAll(help.substr(list), "^  ([a-z]+) "))
    addCommands(folder, command + (command.empty() ? "" : " ") + below, commands);
}

// The names of options that a help lists: those at the begin of a line, with commas between.
Words optionsOf(const TemporaryFolder& folder, const std::string& command) {
  Words names;
  const std::string help = runProgram(folder, command + " --help").out;
  for (const std::string& list : findAll(help, "^  (-[^ ]+)"))
    for (const std::string& name : findAll(list, "(?:^|,)(-[a-zA-Z0-9-]+)")) names.push_back(name);
  return names;
}

std::string replaced(std::string text, char what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) text.replace(at, 1, by);
  return text;
}

// The text from `begin` to the next `end`; empty where there is no such begin.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  return from == std::string::npos ? std::string() : text.substr(from, text.find(end, from) - from);
}

// What bash offers for the last of some words, in the folder `files`. @param line  as a list of words of bash
Words offeredByBash(const TemporaryFolder& folder, const std::string& line) {
  const std::string script =
      "source <(\"$umbrick\" completion bash); COMP_WORDS=(" + line +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); cd files; _umbrick; printf \"%s\\n\" \"${COMPREPLY[@]}\"";
  const ProgramResult result = runShell(folder, "cat >script <<'END'\n" + script + "\nEND\nbash script; rm script");
  CHECK(result.err.empty());
  Words words = linesOf(result.out);
  if (words == Words{""}) words.clear();
  std::sort(words.begin(), words.end());
  return words;
}

// What fish offers for a line in the folder `files`; only the words, without what it says of them.
Words offeredByFish(const TemporaryFolder& folder, const std::string& line) {
  const ProgramResult result =
      runShell(folder, "printf '%s\\n' '$umbrick completion fish | source' 'cd files' 'complete -C \"" + line +
                           "\"' >script; HOME=$PWD fish script; rm -rf script .config .local .cache");
  CHECK(result.err.empty());
  Words words = findAll(result.out, "^([^\t\n]+)");
  std::sort(words.begin(), words.end());
  return words;
}

const Words kModeWords{"average", "hybrid", "integrate", "isosurface", "minip", "mip", "xray"};

}  // namespace

TEST_CASE("Every option of every help is in the manual and in the completion of each shell", "[tools]") {
  const TemporaryFolder folder;
  const std::string bash = runProgram(folder, "completion bash").out;
  const std::string zsh = runProgram(folder, "completion zsh").out;
  const std::string fish = runProgram(folder, "completion fish").out;
  Words commands;
  addCommands(folder, "", commands);
  REQUIRE(commands.size() > 12);
  std::size_t looked = 0;
  for (const std::string& command : commands) {
    const std::string page = runProgram(folder, "manual " + command).out;
    const std::string inBash = between(between(bash, "\n_umbrick_options()", "\n}"), "    '" + command + "') ", ";;");
    const std::string name = "_umbrick" + (command.empty() ? "" : "_" + replaced(command, ' ', "_"));
    const std::string inZsh = between(zsh, "\n" + name + "() {", "\n}");
    const Words fishLines = findAll(fish, "^complete -c umbrick -n '__umbrick_in " + command + "' (.*)");
    std::string inFish;
    for (const std::string& line : fishLines) inFish += line + "\n";
    for (const std::string& option : optionsOf(folder, command)) {
      CAPTURE(command, option);
      CHECK_THAT(page, Contains("\\fB" + replaced(option, '-', "\\-") + "\\fR"));
      CHECK_THAT(inBash + " ",
                 Contains(' ' + option + ' ') || Contains('\'' + option + ' ') || Contains(' ' + option + '\''));
      CHECK(std::regex_search(inZsh, std::regex("[{,' ]" + option + "[,}=+'\\[]")));
      const std::string inLine = option[1] == '-' ? "-l " + option.substr(2) : "-s " + option.substr(1);
      CHECK_THAT(inFish, Contains(inLine + ' '));
      ++looked;
    }
  }
  CHECK(looked > 300);
}

TEST_CASE("bash completes commands, options, words and files", "[tools]") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "files");
  std::ofstream(folder.path() / "files" / "a scan.nii");
  std::ofstream(folder.path() / "files" / "scene.json");
  const auto offered = [&](const std::string& line) { return offeredByBash(folder, line); };
  CHECK(offered("umbrick ren") == Words{"render"});
  CHECK(offered("umbrick tf ''") == Words{"auto", "list"});
  CHECK(offered("umbrick completion ''") == Words{"bash", "fish", "zsh"});
  CHECK(offered("umbrick render --mode ''") == kModeWords);
  CHECK(offered("umbrick render --mode = mi") == Words{"minip", "mip"});
  CHECK(offered("umbrick render scene.json --mo") == Words{"--mode", "--model"});
  CHECK(offered("umbrick render ''") == Words{"a scan.nii", "scene.json"});
  CHECK(offered("umbrick render --strict s") == Words{"scene.json"});
  CHECK(offered("umbrick render --tf s") == Words{"scene.json", "smoke"});
  CHECK(offered("umbrick convert a.nrrd b.nrrd 'a '") == Words{"a scan.nii"});
  // Numbers are not offered, and what follows them is the next argument.
  CHECK(offered("umbrick render --dims 2 ''").empty());
  CHECK(offered("umbrick render --dims 2 3 4 s") == Words{"scene.json"});
  CHECK(offered("umbrick render --eye 1 -2 3 s") == Words{"scene.json"});
  CHECK(offered("umbrick render --annotate triad,sc") == Words{"triad,scale"});
  CHECK(offered("umbrick study --methods dos ra") == Words{"rays", "rays-gl", "rays-gl-box", "rays-gl-light-volume",
                                                           "rays-light-volume", "rays-midpoint", "rays-pre"});
  CHECK(offered("umbrick nothing s").empty());
}

TEST_CASE("fish completes commands, options, words and files", "[tools]") {
  if (!hasProgram("fish")) return;
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "files");
  std::ofstream(folder.path() / "files" / "scene.json");
  const auto offered = [&](const std::string& line) { return offeredByFish(folder, line); };
  CHECK(offered("umbrick ren") == Words{"render"});
  CHECK(offered("umbrick tf ") == Words{"auto", "list"});
  CHECK(offered("umbrick render --mode ") == kModeWords);
  CHECK(offered("umbrick render sc") == Words{"scene.json"});
  CHECK(offered("umbrick render --tf s") == Words{"scene.json", "smoke"});
  CHECK(offered("umbrick render scene.json --mod") == Words{"--mode", "--model"});
  CHECK(offered("umbrick completion ") == Words{"bash", "fish", "zsh"});
}

TEST_CASE("zsh takes the completion without an error", "[tools]") {
  if (!hasProgram("zsh")) return;
  const TemporaryFolder folder;
  // Read as a file, then as the autoloaded function that a folder of $fpath has.
  const ProgramResult result = runShell(
      folder,
      "mkdir f && $umbrick completion zsh >f/_umbrick && zsh -n f/_umbrick && "
      "zsh -f -c 'fpath=($PWD/f $fpath); autoload -Uz compinit; compinit -u -d $PWD/dump; "
      "print ${_comps[umbrick]}; source f/_umbrick; _umbrick_render 2>&1 | head -1; whence -w _umbrick_tf_list'");
  CHECK(result.err.empty());
  CHECK_THAT(result.out, Contains("_umbrick\n") && Contains("_umbrick_tf_list: function"));
}

TEST_CASE("The pages of the manual give troff nothing to warn of", "[tools]") {
  if (!hasProgram("groff")) return;
  const TemporaryFolder folder;
  const ProgramResult result = runShell(
      folder, "$umbrick manual --folder pages && ls pages | wc -l && groff -man -Tutf8 -ww -rLL=100n -z pages/*.1");
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  Words commands;
  addCommands(folder, "", commands);
  CHECK(std::stoul(result.out) == commands.size());
  CHECK(fs::exists(folder.path() / "pages" / "umbrick-tf-list.1"));
}

TEST_CASE("A page of the manual is asked for by the words of its command", "[tools]") {
  const TemporaryFolder folder;
  CHECK_THAT(runProgram(folder, "manual tf list").out, Contains("umbrick\\-tf\\-list \\- list the presets"));
  const ProgramResult refused = runProgram(folder, "manual paint");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("expected one of convert, ") && Contains("tf list") && Contains("found 'paint'"));
  CHECK(runProgram(folder, "manual render --folder pages").status == 2);
  CHECK_FALSE(fs::exists(folder.path() / "pages"));
  CHECK(runProgram(folder, "completion tcsh").status == 2);
}

// Shorter tests run the same commands.
TEST_CASE("The examples of the manual work as they stand", "[tools][slow]") {
  const TemporaryFolder folder;
  for (const char* file : {"densityAndHeat.vdb", "headsq_256x256x94_uint16le.raw.gz"})
    fs::create_symlink(fs::path(UMBRICK_ASSETS) / file, folder.path() / file);
  Words commands;
  addCommands(folder, "", commands);
  std::size_t ran = 0;
  for (const std::string& command : commands) {
    const std::string page = replaced(runProgram(folder, "manual " + command).out, '\\', "");
    const std::string examples = between(page, ".SH EXAMPLES", ".SH EXIT STATUS");
    for (const std::string& line : findAll(examples, "^(umbrick .*)$")) {
      CAPTURE(line);
      // A study takes minutes, and the viewer goes on until it is stopped; pipes are for people.
      if (line.find("|") != std::string::npos || line.starts_with("umbrick study") || line.starts_with("umbrick view"))
        continue;
      const ProgramResult result = runProgram(folder, line.substr(8));
      INFO(result.err);
      CHECK(result.status == 0);
      ++ran;
    }
  }
  CHECK(ran >= 10);
}
