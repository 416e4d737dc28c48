// Finds where two JSON values differ, for messages.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace umbrick {
class JsonDocument;

/// Returns the first difference, in the order of `here`: "camera.fov is 27 there and 30 here"; empty: equal.
/// @param path  of the values; empty at the root
std::string firstDifference(const std::string& path, const nlohmann::ordered_json& there,
                            const nlohmann::ordered_json& here);

/// Checks that a text is nested no deeper than records are: what compares them goes down by recursion. @throw IoError
void checkDepth(const JsonDocument& document, const std::string& source);

}  // namespace umbrick
