// Writing JSON: each function returns the text of one value, and values are put together from the inside out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace umbrick {

/// The shortest text that reads back as the same number. @throw InvalidArgument  not finite: JSON has no such number
std::string jsonNumber(double number);
/// An angle in degrees; JsonValue::degrees() reads back the same radians. Has more digits than a double where one in
/// degrees cannot say it.
std::string jsonDegrees(double radians);
/// @throw InvalidArgument  not UTF-8
std::string jsonString(const std::string& text);
std::string jsonArray(const std::vector<std::string>& values);
std::string jsonNumbers(const std::vector<double>& numbers);
using JsonFields = std::vector<std::pair<std::string, std::string>>;
/// Fields in the order given. Objects and arrays stay on one line where they fit.
std::string jsonObject(const JsonFields& fields);

}  // namespace umbrick
