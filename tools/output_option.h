// What the names of outputs mean on the command line, for all commands that write files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "command_line.h"

namespace umbrick::tools {

/// Adds --force.
CLI::Option* addForceOption(CLI::App& command, bool& force);

/// Looks at an output before anything is computed; an empty one is none. "-" becomes /dev/stdout, and what is printed
/// besides goes to stderr from then on. The names of stderr become that of messageDescriptor(). Says on stderr what
/// becomes of other names of a file that is replaced.
/// @throw IoError  it cannot be written, or is not to be replaced without `force`
void prepareOutput(std::filesystem::path& output, bool force);

/// Tells whether an output is written through rather than replaced, so that its name says nothing of its format.
bool isStream(const std::filesystem::path& output);

/// Returns the name of an output that was written, to be printed to stdout: as it is for a program that reads it, and
/// as printable() has it on a terminal.
std::string shownName(const std::filesystem::path& output);

/// Returns "exr" or "png", by the extension, or else as `format` says.
/// @param format  what --format gives, for streams "png" where that is empty  @throw UsageError
std::string pictureFormat(const std::filesystem::path& output, const std::string& format);
/// Adds --format of pictures.
CLI::Option* addPictureFormat(CLI::App& command, std::string& format);

}  // namespace umbrick::tools
