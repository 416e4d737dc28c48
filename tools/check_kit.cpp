// SPDX-License-Identifier: Apache-2.0
#include "check_kit.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "progress.h"
#include "umbrick/core/short_number.h"
#include "validators.h"

namespace umbrick::tools {
namespace {

constexpr const char* kExport = "--export";
constexpr const char* kAgainst = "--against";

std::string shortly(double number) { return shortNumber(number, 3); }

std::string padded(const std::string& text, std::size_t width, bool right = false) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return right ? blanks + text : text + blanks;
}

// Prints columns as wide as what is in them. @param numbers  whether a column is aligned to the right
void printColumns(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& numbers,
                  const std::function<void(std::size_t row)>& below) {
  std::vector<std::size_t> widths(numbers.size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t c = 0; c < rows[r].size(); ++c) line += padded(rows[r][c], widths[c], numbers[c]) + "  ";
    while (line.ends_with(' ')) line.pop_back();
    std::cout << line << '\n';
    if (r > 0) below(r - 1);
  }
}

void printNotAnswered(const std::vector<KitVerdict>& verdicts) {
  std::map<std::string, std::string> byCase;
  std::size_t count = 0;
  for (const KitVerdict& verdict : verdicts) {
    if (verdict.outcome != KitOutcome::notAnswered) continue;
    std::string& list = byCase[verdict.kitCase];
    list += (list.empty() ? "" : ", ") + verdict.asked;
    ++count;
  }
  if (count == 0) return;
  std::cout << "not answered: " << count << (count == 1 ? " question: " : " questions: ");
  bool first = true;
  for (const auto& [name, list] : byCase) {
    std::cout << (first ? "" : "; ") << name << " (" << list << ')';
    first = false;
  }
  std::cout << '\n';
}

void printVerdicts(const KitJudgement& judgement) {
  std::vector<const KitVerdict*> shown;
  for (const KitVerdict& verdict : judgement.verdicts)
    if (verdict.outcome != KitOutcome::notAnswered) shown.push_back(&verdict);
  std::vector<std::vector<std::string>> rows{
      {"case", "answer", "invariant", "largest", "limit", "RMSE", "limit", "wrong", ""}};
  for (const KitVerdict* verdict : shown) {
    const bool measured = verdict->limit > 0;
    rows.push_back({verdict->kitCase, verdict->asked, verdict->invariant, measured ? shortly(verdict->worst) : "-",
                    measured ? shortly(verdict->limit) : "-", measured ? shortly(verdict->rmse) : "-",
                    verdict->rmseLimit > 0 ? shortly(verdict->rmseLimit) : "-",
                    verdict->compared > 0 ? std::to_string(verdict->wrong) : "-",
                    verdict->outcome == KitOutcome::passed ? "ok" : "FAILED"});
  }
  if (!shown.empty())
    printColumns(rows, {false, false, false, true, true, true, true, true, false}, [&](std::size_t row) {
      const KitVerdict& verdict = *shown[row];
      if (verdict.outcome != KitOutcome::failed) return;
      std::cout << "   " << verdict.where << '\n';
      if (!verdict.hint.empty()) std::cout << "   hint: " << verdict.hint << '\n';
    });
  printNotAnswered(judgement.verdicts);
}

const char* nameOf(KitOutcome outcome) {
  return outcome == KitOutcome::passed ? "passed" : outcome == KitOutcome::failed ? "failed" : "not answered";
}

void printJson(const KitJudgement& judgement, const KitTolerance& tolerance) {
  nlohmann::ordered_json json;
  json["passed"] = judgement.passed();
  json["complete"] = judgement.complete;
  json["tolerance"] = tolerance.picture;
  json["rounding"] = tolerance.rounding;
  json["unknown_files"] = judgement.unknown;
  json["verdicts"] = nlohmann::ordered_json::array();
  for (const KitVerdict& verdict : judgement.verdicts)
    json["verdicts"].push_back({{"case", verdict.kitCase},
                                {"answer", verdict.asked},
                                {"invariant", verdict.invariant},
                                {"outcome", nameOf(verdict.outcome)},
                                {"largest", verdict.worst},
                                {"limit", verdict.limit},
                                {"rmse", verdict.rmse},
                                {"rmse_limit", verdict.rmseLimit},
                                {"compared", verdict.compared},
                                {"wrong", verdict.wrong},
                                {"where", verdict.where},
                                {"hint", verdict.hint}});
  std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

}  // namespace

void addKitOptions(CLI::App& check, KitCommand& command) {
  const std::string group = "Kits for other renderers";
  CLI::Option* exported = check.add_option(
      kExport, command.exportTo,
      "write a kit into this new folder and check nothing: bricks, points with their values, slices and "
      "reference pictures with error bars, of the volume or, without one, of built-in hard cases; its "
      "README.md says the rest");
  CLI::Option* against = check.add_option(
      kAgainst, command.against, "judge what another renderer has written into the folder answers of this kit");
  exported->group(group)->excludes(against);
  against->group(group);
  check.add_option("--points", command.options.samples, "of each case whose values are asked for")
      ->check(CLI::Range(12, 10000000))
      ->needs(exported)
      ->capture_default_str()
      ->group(group);
  check
      .add_option(
          "--tolerance", command.tolerance.picture,
          "by how much a channel of a pixel may be off beyond the error bar, linear; the root of the mean square "
          "by a quarter of it")
      ->check(numberIn(1e-9, 1, "1e-9 to 1"))
      ->needs(against)
      ->capture_default_str()
      ->group(group);
  check
      .add_option("--rounding", command.tolerance.rounding,
                  "by how much a sample may be off, as a share of the range of the volume's values; 4e-3 for texture "
                  "units with weights of 8 bits")
      ->check(numberIn(1e-9, 1, "1e-9 to 1"))
      ->needs(against)
      ->capture_default_str()
      ->group(group);
}

void checkKitOptions(const CLI::App& check, const KitCommand& command, bool hasInput) {
  const bool judging = !command.against.empty();
  // All others describe a scene, or what is checked.
  const std::vector<std::string> own = judging
                                           ? std::vector<std::string>{kAgainst, "--tolerance", "--rounding", "--json"}
                                           : std::vector<std::string>{kExport, "--points", "--seed"};
  const std::vector<std::string> ofCheck{"--edges", "--slices", "--json", "--backend", "--light-sweep"};
  const auto has = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const CLI::Option* option : check.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || has(own, name)) continue;
    if (judging) throw UsageError(name + ": does not go with " + kAgainst + ", which takes a kit as it is");
    if (has(ofCheck, name)) throw UsageError(name + ": does not go with " + kExport + ", which checks nothing");
    if (!hasInput) throw UsageError(name + ": goes with a volume, and " + kExport + " has none here");
  }
}

int writeKit(const KitCommand& command, const std::function<std::vector<KitCase>()>& cases) {
  StopRequest stop;
  const std::vector<KitCase> made = cases();
  ProgressBar bar("kit");
  stop.keepParts();  // the time to take away what is written
  KitOptions options = command.options;
  options.progress = [&](const std::string& step, double done) {
    bar.show(done, step);
    return !stop.requested();
  };
  const KitSummary summary = exportKit(command.exportTo, made, options);
  bar.clear();
  if (!summary.complete) throw Interrupted("interrupted; nothing was written");
  for (const std::string& note : summary.notes) std::cerr << note << '\n';
  std::cerr << summary.cases << (summary.cases == 1 ? " case: " : " cases: ") << summary.bricks << " bricks, "
            << summary.samples << " samples, " << summary.pictures << " pictures with error bars of at most "
            << shortly(summary.largestErrorBar) << "; README.md says what another renderer is asked for\n";
  std::cout << command.exportTo.string() << '\n';
  return 0;
}

int judgeAnswers(const KitCommand& command, bool json) {
  StopRequest stop;
  ProgressBar bar("judging");
  stop.keepParts();
  const KitJudgement judgement =
      judgeKit(command.against, command.tolerance, [&](const std::string& step, double done) {
        bar.show(done, step);
        return !stop.requested();
      });
  bar.clear();
  if (json)
    printJson(judgement, command.tolerance);
  else
    printVerdicts(judgement);
  for (const std::string& file : judgement.unknown) std::cerr << file << ": no case asks for this file\n";
  if (!judgement.complete) std::cerr << "umbrick: interrupted: not all answers are judged\n";
  const bool answered = std::any_of(judgement.verdicts.begin(), judgement.verdicts.end(),
                                    [](const auto& verdict) { return verdict.outcome != KitOutcome::notAnswered; });
  if (judgement.complete && !answered)
    std::cerr << "umbrick: " << command.against.string()
              << ": nothing is answered; the kit's README.md says where answers go\n";
  return judgement.passed() ? 0 : 1;
}

}  // namespace umbrick::tools
