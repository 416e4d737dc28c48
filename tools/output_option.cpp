// SPDX-License-Identifier: Apache-2.0
#include "output_option.h"

#include <unistd.h>

#include <iostream>

#include "command.h"
#include "foreign_messages.h"
#include "umbrick/core/output.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

// Says what becomes of the other names of a file.
void tellOtherNames(const Output& output) {
  if (!output.standing || output.standing->names < 2) return;
  std::cerr << output.given.string() << ": has " << output.standing->names
            << " names (hard links), of which this one gets the new content and the others keep the old\n";
}

}  // namespace

CLI::Option* addForceOption(CLI::App& command, bool& force) {
  return command.add_flag("--force", force, "replace outputs that are read-only or belong to another user");
}

void prepareOutput(fs::path& path, bool force) {
  if (path.empty()) return;
  if (path == "-") path = "/dev/stdout";
  const Output output = outputAt(path);
  // Nothing is to stand between the data.
  if (output.descriptor == STDOUT_FILENO) std::cout.rdbuf(std::cerr.rdbuf());
  // That number is where the messages of libraries are caught; the user means the stderr of the shell.
  if (output.descriptor == STDERR_FILENO) path = "/dev/fd/" + std::to_string(messageDescriptor());
  if (const auto why = whyProtected(output); why && !force)
    throw IoError(path.string() + ": cannot write: " + *why + "; --force replaces it");
  tellOtherNames(output);
  PendingFile probe(path);
}

bool isStream(const fs::path& path) { return path == "-" || outputAt(path).isStream(); }

std::string shownName(const fs::path& output) {
  return isatty(STDOUT_FILENO) == 1 ? printable(output.string()) : output.string();
}

std::string pictureFormat(const fs::path& output, const std::string& format) {
  const fs::path extension = output.extension();
  if (extension == ".exr" || extension == ".png") return extension.string().substr(1);
  if (!format.empty()) return format;
  if (!isStream(output)) throw UsageError(output.string() + ": expected a picture that ends in .exr or .png");
  return "png";
}

CLI::Option* addPictureFormat(CLI::App& command, std::string& format) {
  return command
      .add_option("--format", format,
                  "of pictures whose names do not end in .png or .exr, such as - (stdout): png or exr [png]")
      ->check(CLI::IsMember({"png", "exr"}));
}

}  // namespace umbrick::tools
