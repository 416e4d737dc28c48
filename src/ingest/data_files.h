// The files that hold the voxels of a volume whose header names them, or the header's own file: equal shares in order.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ingest/header_fields.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Whether the value of a field for data files is LIST, as in "LIST 2D": the names follow, one a line. A file may be
/// called list.raw.
bool announcesList(std::string_view value);

/// How a format spells the names of its data files.
struct DataFileField {
  std::string key, title;         // of the field, and what messages call it
  bool stepMayBeMissing = false;  // of "slice%03d.raw 1 20 1", whose last number is the step
};

/// The data files, beside the header: `list` after LIST, or those of a pattern with first, last and step, or the one of
/// that name. Empty where there is no name. @throw IoError  a pattern that is none
std::vector<std::filesystem::path> dataFiles(const HeaderFields& fields, const DataFileField& field,
                                             const std::vector<std::string>& list);

/// One share of the voxels as plain bytes.
/// @param offset  where the share begins in the file, but for what the header says to skip
/// @param bytes   of voxels in each share
using OpenShare =
    std::function<std::unique_ptr<ByteStream>(const std::filesystem::path&, std::int64_t offset, std::int64_t bytes)>;

/// The shares, joined. Each is opened at once and again when its turn comes: a missing or short file is told before the
/// first voxel is read. What is wrong with one is said by the names of header and file. Adds the sizes of `files` to
/// info.fileBytes.
/// @param files        empty: the voxels follow the header in its own file
/// @param headerBytes  of the header
/// @throw IoError      as `open` does, or voxels that are no multiple of the files
std::unique_ptr<ByteStream> openDataFiles(VolumeInfo& info, const std::string& fieldTitle,
                                          const std::filesystem::path& header, std::int64_t headerBytes,
                                          const std::vector<std::filesystem::path>& files, const OpenShare& open);

/// A share whose file may be longer, for which `longer` gets a note; where it is null, that is an error.
using OpenNotedShare = std::function<std::unique_ptr<ByteStream>(const std::filesystem::path&, std::int64_t offset,
                                                                 std::int64_t bytes, std::vector<std::string>* longer)>;

/// The same voxels each time that the function is called. All files are looked at before it returns, and what they have
/// behind the voxels becomes notes of `info`.
/// @param strict  that is an error
std::function<std::unique_ptr<ByteStream>()> openDataOften(VolumeInfo& info, const std::string& fieldTitle,
                                                           const std::filesystem::path& header,
                                                           std::int64_t headerBytes,
                                                           const std::vector<std::filesystem::path>& files, bool strict,
                                                           const OpenNotedShare& open);

/// Checks that a header and the files that it names lie beside or below it, links and ".." followed. @throw IoError
void requireDataBeside(const std::vector<std::filesystem::path>& files, const std::filesystem::path& header);

/// The size of a share's file. @throw IoError  missing, a directory, a pipe or device, made up by the system
std::int64_t dataFileSize(const std::filesystem::path& path);

/// A share of voxels that are stored as they are.
/// @param skip  bytes after `offset`; -1: the voxels are the last bytes of the file
/// @param longer  gets a note where the file is longer; null: that is an error
/// @throw IoError  the file does not end with the last voxel
std::unique_ptr<ByteStream> openPlainShare(const std::filesystem::path& path, std::int64_t offset, std::int64_t skip,
                                           std::int64_t bytes, VoxelType type, std::vector<std::string>* longer);

}  // namespace umbrick
