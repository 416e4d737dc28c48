// Words, numbers and file names in headers that are written as text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace umbrick {

/// The text with its capital ASCII letters made small.
std::string lower(std::string_view text);
/// The text without blanks, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text);
/// The words between blanks; a word in quotes may hold blanks.
std::vector<std::string> words(std::string_view text);
/// The whole text as a number, or nothing.
std::optional<std::int64_t> integer(std::string_view text);
std::optional<double> number(std::string_view text);
/// The text in quotes and short enough for a message, or "nothing" when it is empty.
std::string shortened(std::string_view text);

/// @throw IoError  "path: field: expected ..., found ..."
[[noreturn]] void failField(const std::filesystem::path& path, const std::string& field, const std::string& expected,
                            std::string_view found);

/// The value beside `name` in a table of pairs, or nothing.
template <class Table>
auto valueNamed(const Table& table, std::string_view name) {
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& each) { return each.first == name; });
  return row == table.end() ? std::nullopt : std::optional(row->second);
}

/// A file name with one number in it: "slice%03d.raw". Patterns come from files, so printf never sees them.
struct NamePattern {
  std::string before, after;
  std::size_t digits = 0;  // how many characters the number has at least
  char padding = ' ';
  std::string name(std::int64_t number) const;
};
/// Nothing when `text` has not exactly one %d, %4d or %04d.
std::optional<NamePattern> namePattern(std::string_view text);

/// The names from `first` to `last`. There are none when one of the texts is no number, the pattern is none, or there
/// would be a million files.
std::vector<std::string> numberedNames(std::string_view pattern, std::string_view first, std::string_view last,
                                       std::string_view step);

}  // namespace umbrick
