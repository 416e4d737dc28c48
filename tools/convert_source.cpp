// SPDX-License-Identifier: Apache-2.0
#include "convert_source.h"

#include <bit>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string>

#include "command.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

std::optional<glm::dvec3> vector(const std::optional<std::array<double, 3>>& v) {
  return v ? std::optional(glm::dvec3((*v)[0], (*v)[1], (*v)[2])) : std::nullopt;
}

OpenOptions openInput(const ConvertCommand& command) {
  OpenOptions open;
  open.series = command.options.source.open.series;
  open.lengthUnit = command.options.source.open.lengthUnit;
  open.strict = command.options.source.open.strict;
  open.besideOnly = command.options.source.open.besideOnly;
  open.where = command.options.source.open.where;
  open.overridePlace = command.options.source.open.overridePlace;
  if (command.space != "file") open.space = command.space;
  for (char& letter : open.space) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  open.parts.frame = command.frame;
  if (!command.component.empty() && command.component != "all") chooseComponent(command.component, open.parts);
  if (!command.raw()) {
    if (command.components != 1) throw UsageError("--components is for headerless raw, with --dims and --type");
    open.spacing = vector(command.spacing);
    open.origin = vector(command.origin);
    return open;
  }
  if (command.dims.size() != 3 || command.type.empty())
    throw UsageError(command.inputs.front().string() + ": headerless raw needs --dims and --type");
  RawOptions raw;
  raw.dims = {command.dims[0], command.dims[1], command.dims[2]};
  raw.type = *voxelTypeFromName(command.type);
  raw.endian = command.endian == "big" ? std::endian::big : std::endian::little;
  raw.headerBytes = command.headerBytes;
  raw.components = command.components;
  if (command.bitsStored != 0) raw.bitsStored = command.bitsStored;
  raw.spacing = vector(command.spacing).value_or(raw.spacing);
  raw.origin = vector(command.origin).value_or(raw.origin);
  open.raw = raw;
  return open;
}

// A headerless mask lies as the input does, with voxels of its own type and nothing else in its file.
OpenOptions openMask(const ConvertCommand& command) {
  ConvertCommand mask = command;
  mask.options.source.open.series.clear();
  mask.options.source.open.where.clear();
  mask.space.clear();  // a mask follows the input
  mask.headerBytes = 0;
  mask.component.clear();
  mask.components = 1;
  mask.frame.reset();
  mask.bitsStored = 0;
  if (formatOfName(command.options.source.mask)) {
    mask.dims.clear();
    mask.type.clear();
  } else if (!mask.type.empty()) {
    mask.type = command.maskType;
  }
  return openInput(mask);
}

void checkRaw(const ConvertCommand& command) {
  for (const fs::path& input : command.inputs) {
    const std::string extension = input.extension().string();
    const auto named =
        extension == ".vdb" || extension == ".nvdb" ? std::optional<std::string>(extension) : formatOfName(input);
    if (command.raw() && named)
      throw UsageError(input.string() + ": --dims and --type are for headerless raw, not for " + *named);
  }
}

}  // namespace

SourceOptions sourceOptions(const ConvertCommand& command) try {
  checkRaw(command);
  SourceOptions source = command.options.source;
  source.open = openInput(command);
  if (!source.mask.empty()) source.openMask = openMask(command);
  if (command.crop) {
    const auto& c = *command.crop;
    source.crop = {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
  }
  if (command.resample.size() == 2) throw UsageError("--resample: expected one spacing or three, found 2");
  if (!command.resample.empty()) {
    const std::vector<double>& s = command.resample;
    source.resample = {s.front(), s[s.size() / 2], s.back()};
    source.open.evenSlices = true;
  }
  source.backgroundFromBorder = command.background == "auto";
  return source;
} catch (const InvalidArgument& error) {
  throw UsageError("--" + std::string(error.what()));
}

}  // namespace umbrick::tools
