// Writing JSON: each function returns the text of one value, and values are put together from the inside out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace umbrick {

/// Returns the shortest text that reads back as the same number.
/// @throw InvalidArgument  the number is not finite; JSON has none that is not
std::string jsonNumber(double number);
/// Returns an angle in degrees, from which JsonValue::degrees() reads back the same radians. Where a double in degrees
/// cannot say the angle, the text has more digits than a double.
std::string jsonDegrees(double radians);
/// Bytes that are no UTF-8 become \xNN: JSON holds none.
std::string jsonString(const std::string& text);
std::string jsonArray(const std::vector<std::string>& values);
std::string jsonNumbers(const std::vector<double>& numbers);
using JsonFields = std::vector<std::pair<std::string, std::string>>;
/// Writes the fields in the order given. Objects and arrays stay on one line where they fit.
std::string jsonObject(const JsonFields& fields);

}  // namespace umbrick
