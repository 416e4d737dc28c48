// The text at the head of a NRRD file. Own code, since the library for the format, teem, gives the voxels of a file by
// nrrdLoad as one array and not as slabs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ingest/parts.h"
#include "ingest/volume_time.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

enum class NrrdEncoding { raw, gzip, bzip2, text, hex };

/// What the header says. It is checked, and has three axes of space however many the file had.
struct NrrdHeader {
  glm::i64vec3 dims{1};
  std::int64_t components = 1, frames = 1;
  PartAxes parts;  // where these two stand
  VoxelMeaning meaning = VoxelMeaning::scalar;
  glm::dmat3 measurementFrame{1};  // of vectors
  std::vector<std::string> notes;
  VoxelType type = VoxelType::u8;
  NrrdEncoding encoding = NrrdEncoding::raw;
  bool bigEndian = false;
  std::int64_t lineSkip = 0, byteSkip = 0;       // byteSkip -1: the voxels are the last bytes of the file
  std::vector<std::filesystem::path> dataFiles;  // empty: the data follow the header
  std::int64_t bytes = 0;                        // size of the header with its closing blank line
  glm::dmat4 indexToWorld{1};                    // in the unit of the file
  std::optional<glm::dvec3> millimetres;         // of that unit along each axis of the world, where it is known
  VolumeTimes times;                             // of frames
  std::map<std::string, std::string> metadata;   // fields that do not change voxels, and the key/value pairs
};

/// @throw IoError  naming the file, the field, what was expected and what was found
NrrdHeader readNrrdHeader(const std::filesystem::path& path);

}  // namespace umbrick
