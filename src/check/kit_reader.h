// A kit as it is read back, and the files of those who answer it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "check/kit_files.h"
#include "check/kit_samples.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/image/image.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

struct AskedPicture {
  std::string name;
  ResolvedScene scene;
  Image colour, errorBar, depth;
};

/// A case with all that answers are judged by.
struct AskedCase {
  std::string name;
  ScalarGrid grid;
  std::vector<glm::ivec3> origins;  // of the bricks
  BrickFinder bricks;
  IndexBox box;  // of the dense voxels
  double valueRange = 0;
  std::vector<KitSample> samples;
  std::vector<AskedPicture> pictures;
};

/// Returns the names of a kit's cases. @throw IoError  no kit, or one of another format
std::vector<std::string> readKit(const KitFiles& files);
/// @throw IoError, InvalidArgument  a file is missing or not what it should be
AskedCase readCase(const KitFiles& files, const std::string& name);

/// Returns the file that answers a question, if there is one.
/// @param stem  of the file, without its extension
/// @throw InvalidArgument  there are two
std::optional<std::filesystem::path> findAnswer(const std::filesystem::path& folder, const std::string& stem,
                                                const std::vector<std::string>& extensions);
inline const std::vector<std::string> kPictureExtensions{".exr", ".png", ".npy", ".raw"};
inline const std::vector<std::string> kSampleExtensions{".csv"};

/// Reads a picture that a renderer has made. @param width,height  of the picture that was asked for: a .raw has no size
/// @throw IoError, InvalidArgument  it is not whole, or has no four channels
Image readPictureAnswer(const std::filesystem::path& path, int width, int height);
/// Reads one value for each sample, in their order. @throw IoError  a sample is missing, twice there or unknown
std::vector<double> readSampleAnswer(const std::filesystem::path& path, std::size_t samples);

}  // namespace umbrick
