// SPDX-License-Identifier: Apache-2.0
#include "core/json_writer.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"

namespace umbrick {
namespace {

// Pi is a double here, so that the double pi / 3 is 60 degrees.
constexpr long double kDegree = 3.14159265358979323846 / 180.0L;

template <typename T>
std::string shortest(T number) {
  std::array<char, 64> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return {text.data(), end};
}

void checkFinite(double number) {
  if (!std::isfinite(number)) throw InvalidArgument("JSON has no number for " + std::to_string(number));
}

std::string bracketed(char open, const std::vector<std::string>& parts, char close) {
  constexpr std::size_t kLine = 110;  // characters
  std::size_t length = 0;
  bool oneLine = true;
  for (const std::string& part : parts) {
    length += part.size() + 2;
    oneLine = oneLine && part.find('\n') == std::string::npos;
  }
  oneLine = oneLine && length <= kLine;
  std::string text(1, open);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += oneLine ? ", " : ",";
    if (!oneLine) text += "\n  ";
    for (const char c : parts[i]) {
      text += c;
      if (c == '\n') text += "  ";
    }
  }
  if (!oneLine) text += '\n';
  return text + close;
}

}  // namespace

std::string jsonNumber(double number) {
  checkFinite(number);
  return shortest(number);
}

std::string jsonDegrees(double radians) {
  checkFinite(radians);
  const long double degrees = radians / kDegree;
  // 60 is written rather than 59.99999999999999, which is as close: the fewest digits that read back right,
  // see JsonValue::degrees().
  std::array<char, 64> text;
  for (int digits = 15; digits <= 17; ++digits) {
    const char* end =
        std::to_chars(text.data(), text.data() + text.size(), degrees, std::chars_format::general, digits).ptr;
    long double read = 0;
    std::from_chars(text.data(), end, read);
    if (static_cast<double>(read * kDegree) == radians)
      return std::string(text.data(), static_cast<std::size_t>(end - text.data()));
  }
  return shortest(degrees);
}

std::string jsonString(const std::string& text) { return nlohmann::json(asUtf8(text)).dump(); }

std::string jsonArray(const std::vector<std::string>& values) { return bracketed('[', values, ']'); }

std::string jsonNumbers(const std::vector<double>& numbers) {
  std::vector<std::string> values;
  values.reserve(numbers.size());
  for (const double number : numbers) values.push_back(jsonNumber(number));
  return jsonArray(values);
}

std::string jsonObject(const JsonFields& fields) {
  std::vector<std::string> parts;
  parts.reserve(fields.size());
  for (const auto& [key, value] : fields) parts.push_back(jsonString(key) + ": " + value);
  return bracketed('{', parts, '}');
}

}  // namespace umbrick
