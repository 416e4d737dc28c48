// Reads what a page sends, which may be anything: a browser's page, or who has its address.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick::view {

/// Longest message of a page, bytes. A transfer function of some ten thousand points is shorter.
inline constexpr std::size_t kMostMessageBytes = 1 << 20;
/// Levels of objects and lists in a message, at most.
inline constexpr int kDeepest = 32;
/// Frames a second that play may be asked for.
inline constexpr double kLeastPlayRate = 0.1, kMostPlayRate = 120;

/// Reads a message of a page. @throw InvalidArgument  no object with a type, or too deeply nested
nlohmann::ordered_json parseMessage(std::string_view text);

/// Returns a field of a message. A whole number is one that the type can hold.
/// @throw InvalidArgument  it is missing or of another kind
template <class Value>
Value messageField(const nlohmann::ordered_json& message, const char* name) {
  try {
    const nlohmann::ordered_json& field = message.at(name);
    if constexpr (std::integral<Value> && !std::same_as<Value, bool>) {
      const bool fits = field.is_number_unsigned()
                            ? std::in_range<Value>(field.get<std::uint64_t>())
                            : field.is_number_integer() && std::in_range<Value>(field.get<std::int64_t>());
      if (fits) return field.get<Value>();
    } else {
      return field.get<Value>();
    }
  } catch (const nlohmann::json::exception&) {
    // is said below
  }
  throw InvalidArgument(std::string("message: ") + name + " is missing or of another kind");
}

/// {"type": "sequence", "number": n, "moving": bool}: asks for a frame.
struct FrameRequest {
  std::int64_t number = 0;
  bool moving = false;  // others follow soon: drafts are enough
};
/// @throw InvalidArgument  see messageField()
FrameRequest parseFrameRequest(const nlohmann::ordered_json& message);

/// {"type": "play", "on": bool, "loop": bool, "fps": x}: what is not named stays as it is.
struct PlayRequest {
  std::optional<bool> on, loop;
  std::optional<double> fps;  // frames a second at most
};
/// @throw InvalidArgument  see messageField(); fps is not from kLeastPlayRate to kMostPlayRate
PlayRequest parsePlayRequest(const nlohmann::ordered_json& message);

}  // namespace umbrick::view
