// SPDX-License-Identifier: Apache-2.0
#include "study/json_difference.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/json_reader.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {
using Json = nlohmann::ordered_json;

std::string shortened(std::string text) {
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

}  // namespace

std::string firstDifference(const std::string& path, const Json& there, const Json& here) {
  if (there == here) return {};
  if (there.is_object() && here.is_object()) {
    std::vector<std::string> keys;
    for (const Json* side : {&here, &there})
      for (const auto& [key, value] : side->items())
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    for (const std::string& key : keys) {
      const std::string below = path.empty() ? key : path + "." + key;
      const std::string difference = firstDifference(below, there.contains(key) ? there[key] : Json(nullptr),
                                                     here.contains(key) ? here[key] : Json(nullptr));
      if (!difference.empty()) return difference;
    }
    return {};
  }
  const auto text = [](const Json& value) { return value.is_null() ? "missing" : shortened(value.dump()); };
  return path + " is " + text(there) + " there and " + text(here) + " here";
}

void checkDepth(const JsonDocument& document, const std::string& source) {
  constexpr std::size_t kDeepest = 64;
  if (document.depth() > kDeepest)
    throw IoError(source + ": expected at most " + std::to_string(kDeepest) + " values in each other, found " +
                  std::to_string(document.depth()));
}

}  // namespace umbrick
