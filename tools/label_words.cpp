// SPDX-License-Identifier: Apache-2.0
#include "label_words.h"

#include <filesystem>
#include <sstream>
#include <system_error>

#include "command.h"

namespace umbrick::tools {

LabelChoice labelChoice(const std::string& text) {
  LabelChoice choice;
  if (text == "all") return choice;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    if (word.empty()) throw UsageError("--labels: expected values or names with commas between, found " + text);
    choice.wanted.push_back(word);
  }
  return choice;
}

std::vector<std::string> completeLabels(std::vector<std::string> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] != "--labels") continue;
    std::error_code ignored;
    const bool list = i + 1 < arguments.size() && !arguments[i + 1].starts_with('-') &&
                      !std::filesystem::exists(arguments[i + 1], ignored);
    if (!list) arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1, "all");
  }
  return arguments;
}

}  // namespace umbrick::tools
