// The names of an enum's values stand once, beside the enum, and are used to read, print, check and list it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {

/// What files and users call a value. The names of an enum are an array of these: kModels, kBackends.
template <class T>
using Name = std::pair<std::string_view, T>;

/// Returns the first name of a value; empty for a value that has none.
template <class T, std::size_t N>
std::string_view nameOf(const Name<T> (&names)[N], T wanted) {
  for (const auto& [name, value] : names)
    if (value == wanted) return name;
  return {};
}

/// Returns all names, in their order.
template <class T, std::size_t N>
std::vector<std::string> listNames(const Name<T> (&names)[N]) {
  std::vector<std::string> list;
  for (const auto& [name, value] : names) list.emplace_back(name);
  return list;
}

/// "a, b, c"
inline std::string joined(const std::vector<std::string>& texts) {
  std::string text;
  for (const std::string& one : texts) text.append(text.empty() ? "" : ", ").append(one);
  return text;
}

/// Returns the value of a name.
/// @param field  is what the message calls it
/// @throw InvalidArgument  another name; lists those there are
template <class T, std::size_t N>
T parseName(const Name<T> (&names)[N], std::string_view text, std::string_view field) {
  for (const auto& [name, value] : names)
    if (name == text) return value;
  throw InvalidArgument(std::string(field) + ": expected one of " + joined(listNames(names)) + ", found '" +
                        std::string(text) + "'");
}

}  // namespace umbrick
