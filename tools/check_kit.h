// umbrick check for people who test renderers of their own: it writes kits and judges the answers to them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>

#include "umbrick/check/kit_export.h"
#include "umbrick/check/kit_verdict.h"

namespace umbrick::tools {

struct KitCommand {
  std::filesystem::path exportTo, against;  // empty: not asked for
  KitOptions options;
  KitTolerance tolerance;
  bool asked() const { return !exportTo.empty() || !against.empty(); }
};

/// Adds the options to umbrick check.
void addKitOptions(CLI::App& check, KitCommand& command);
/// Refuses options of umbrick check that mean nothing beside those of a kit.
/// @param hasInput  a volume is given  @throw UsageError
void checkKitOptions(const CLI::App& check, const KitCommand& command, bool hasInput);

/// Writes a kit. @param cases  makes them  @return the exit status
int writeKit(const KitCommand& command, const std::function<std::vector<KitCase>()>& cases);
/// Judges the answers to one, and prints a table or JSON. @return the exit status
int judgeAnswers(const KitCommand& command, bool json);

}  // namespace umbrick::tools
