// SPDX-License-Identifier: Apache-2.0
#include "check/kit_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/text_file.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"

namespace umbrick {
namespace {

std::string_view withoutBlanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> fieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(withoutBlanks(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

std::string excerpt(std::string_view text) { return "\"" + printable(text.substr(0, 40)) + "\""; }

}  // namespace

std::string tableNumber(double number) {
  if (std::isnan(number)) return "nan";
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), number).ptr;
  return {text, end};
}

KitTable::KitTable(const std::filesystem::path& path) : path_(path), text_(readTextFile(path)) {
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text_.size();) {
    const std::size_t end = std::min(text_.find('\n', begin), text_.size());
    const std::string_view line = withoutBlanks(std::string_view(text_).substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (line.empty()) continue;
    std::vector<std::string_view> fields = fieldsOf(line);
    if (names_.empty()) {
      names_ = std::move(fields);
      continue;
    }
    if (fields.size() != names_.size())
      throw IoError(path_.string() + ":" + std::to_string(number) + ": expected " + std::to_string(names_.size()) +
                    " fields, found " + std::to_string(fields.size()));
    lines_.push_back(std::move(fields));
    numbers_.push_back(number);
  }
  if (names_.empty()) throw IoError(path_.string() + ": expected names of columns in the first line, found nothing");
}

std::vector<double> KitTable::column(std::string_view name) const {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end()) {
    std::string found;
    for (const std::string_view each : names_) found += (found.empty() ? "" : ", ") + printable(each.substr(0, 40));
    throw IoError(path_.string() + ": expected a column \"" + std::string(name) + "\", found " + found);
  }
  const auto index = static_cast<std::size_t>(at - names_.begin());
  std::vector<double> numbers;
  for (std::size_t row = 0; row < lines_.size(); ++row) {
    std::string_view field = lines_[row][index];
    if (field.starts_with('+')) field.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size())
      throw IoError(path_.string() + ":" + std::to_string(numbers_[row]) + ": " + std::string(name) +
                    ": expected a number, found " + excerpt(lines_[row][index]));
    numbers.push_back(value);
  }
  return numbers;
}

std::vector<long> KitTable::wholeColumn(std::string_view name) const {
  std::vector<long> whole;
  constexpr double kMost = 1e15;
  const std::vector<double> numbers = column(name);
  for (std::size_t row = 0; row < numbers.size(); ++row) {
    if (!(std::abs(numbers[row]) < kMost) || numbers[row] != std::floor(numbers[row]))
      throw IoError(path_.string() + ":" + std::to_string(numbers_[row]) + ": " + std::string(name) +
                    ": expected a whole number, found " + tableNumber(numbers[row]));
    whole.push_back(static_cast<long>(numbers[row]));
  }
  return whole;
}

}  // namespace umbrick
