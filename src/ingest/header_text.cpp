// SPDX-License-Identifier: Apache-2.0
#include "ingest/header_text.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::size_t kMaxFiles = 1 << 20;

}  // namespace

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> out;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const bool quoted = text.front() == '"';
    if (quoted) text.remove_prefix(1);
    const std::size_t end = std::min(quoted ? text.find('"') : text.find_first_of(" \t"), text.size());
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::optional<std::int64_t> integer(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::optional<double> number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::string shortened(std::string_view text) {
  return text.empty() ? "nothing" : '"' + std::string(text.substr(0, 60)) + (text.size() > 60 ? "...\"" : "\"");
}

void failField(const std::filesystem::path& path, const std::string& field, const std::string& expected,
               std::string_view found) {
  throw IoError(path.string() + ": " + field + ": expected " + expected + ", found " + shortened(found));
}

std::optional<NamePattern> namePattern(std::string_view text) {
  const std::size_t begin = text.find('%'), end = text.find('d', std::min(begin, text.size()));
  if (end == text.npos || text.find('%', begin + 1) != text.npos) return std::nullopt;
  const std::string_view width = text.substr(begin + 1, end - begin - 1);
  const auto digits = width.empty() ? std::optional<std::int64_t>(0) : integer(width);
  if (!digits || *digits < 0 || *digits > 32) return std::nullopt;
  return NamePattern{std::string(text.substr(0, begin)), std::string(text.substr(end + 1)),
                     static_cast<std::size_t>(*digits), width.starts_with('0') ? '0' : ' '};
}

std::string NamePattern::name(std::int64_t number) const {
  std::string text = std::to_string(number);
  // As printf does: a sign counts, and stands before zeros and behind blanks.
  const std::size_t at = padding == '0' && number < 0 ? 1 : 0;
  text.insert(at, digits - std::min(digits, text.size()), padding);
  return before + text + after;
}

std::vector<std::string> numberedNames(std::string_view pattern, std::string_view firstText, std::string_view lastText,
                                       std::string_view stepText) {
  const auto parsed = namePattern(pattern);
  const auto first = integer(firstText), last = integer(lastText), step = integer(stepText);
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  if (!parsed || !first || !last || !step || *step == 0 || *first < 0 || *last < 0 || *first > kMost || *last > kMost ||
      *step > kMost || *step < -kMost)
    return {};
  std::vector<std::string> names;
  for (std::int64_t i = *first; *step > 0 ? i <= *last : i >= *last; i += *step) {
    if (names.size() >= kMaxFiles) return {};
    names.push_back(parsed->name(i));
  }
  return names;
}

}  // namespace umbrick
