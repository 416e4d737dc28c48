// The options that say what a scene's volume is read from: those of convert that a picture needs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "umbrick/scene/scene.h"

namespace umbrick::tools {

struct VolumeOptions {
  std::optional<std::string> grid, emissionGrid;
  std::vector<std::string> where;
  std::string component;              // of chooseComponent; empty: not given
  std::optional<std::int64_t> frame;  // of a file of several volumes, or the number of a file
  std::string series, type, endian = "little";
  std::vector<std::int64_t> dims;
  std::int64_t headerBytes = 0;
  int bitsStored = 0;
  std::optional<std::vector<double>> spacing, origin;  // three numbers each
  bool besideOnly = false;
};

void addVolumeOptions(CLI::App& command, VolumeOptions& options);

/// What is said of --beside-only.
inline constexpr const char* kBesideOnly =
    "for files of others: refuse a header or scene that names files outside of its own folder and what is below it, "
    "links and \"..\" followed";

/// Sets what the options name. @throw UsageError  headerless raw without its layout, or the other way round
void applyVolumeOptions(const VolumeOptions& options, VolumeReference& volume);

/// Returns the arguments of a program with three numbers behind --spacing or --up put together to one argument. Such an
/// option takes one value or three, and would else take the name of the input that follows one value for the second.
std::vector<std::string> joinVectors(std::vector<std::string> arguments);
/// Reads numbers that are separated by blanks. @return nothing where something else is among them
std::optional<std::vector<double>> parseNumbers(const std::string& text);

}  // namespace umbrick::tools
