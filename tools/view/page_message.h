// Reads what a page sends, which may be anything: a browser's page, or who has its address.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

namespace umbrick::view {

/// Longest message of a page, bytes. A transfer function of some ten thousand points is shorter.
inline constexpr std::size_t kMostMessageBytes = 1 << 20;
/// Levels of objects and lists in a message, at most.
inline constexpr int kDeepest = 32;

/// Reads a message of a page. @throw InvalidArgument  no object with a type, or too deeply nested
nlohmann::ordered_json parseMessage(std::string_view text);

}  // namespace umbrick::view
