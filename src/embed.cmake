# Writes OUTPUT, a C++ file that holds the text of the files NAMES (comma-separated, below BASE); see build_rules.cmake.
# SPDX-License-Identifier: Apache-2.0
string(REPLACE "," ";" names "${NAMES}")
set(entries "")
foreach(name IN LISTS names)
  file(READ ${BASE}/${name} text)
  # Compilers limit the length of one literal (65536 by the standard's minimum): adjacent pieces of 8000 are joined.
  set(pieces "")
  string(LENGTH "${text}" length)
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND pieces "R\"umbrick~(${piece})umbrick~\"\n")
    math(EXPR at "${at} + 8000")
  endwhile()
  string(APPEND entries "    {\"${name}\",\n${pieces}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from the files below ${BASE}.
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace umbrick {
namespace {
constexpr std::pair<std::string_view, std::string_view> kTexts[] = {
${entries}};
}  // namespace

std::string_view ${FUNCTION}(std::string_view name);
std::vector<std::string> ${FUNCTION}Names();

std::string_view ${FUNCTION}(std::string_view name) {
  for (const auto& [key, text] : kTexts)
    if (key == name) return text;
  return {};
}

std::vector<std::string> ${FUNCTION}Names() {
  std::vector<std::string> names;
  for (const auto& entry : kTexts) names.emplace_back(entry.first);
  return names;
}
}  // namespace umbrick
")
