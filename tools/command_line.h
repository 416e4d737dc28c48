// CLI11, with names for the kinds of values that it does not tell from text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>

namespace CLI::detail {

/// Help calls the value of an option for a file or a folder PATH, by which completion offers files.
template <>
constexpr const char* type_name<std::filesystem::path>() {
  return "PATH";
}

}  // namespace CLI::detail

namespace umbrick::tools {

/// Kinds of words that help names instead of listing them. What they are is in command_tree.cpp.
inline constexpr const char* kPresetOrPath = "PRESET|PATH";  // a transfer function
inline constexpr const char* kAxisType = "AXIS";             // what is up
inline constexpr const char* kViewType = "VIEW";             // where the camera stands
inline constexpr const char* kMethodType = "METHOD";         // what a study compares

}  // namespace umbrick::tools
